#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "law/immovable.hpp"
#include "step/newton.hpp"
#include "step/refusals.hpp"

// 2 to 5 of the step: each body alone, the rows, the dense problem, the correction.
namespace trocar::step {

core::Outcome<core::Done> Newton::linearise()
{
  tissue::Tissue& tissue = model_->tissue;
  u_before_ = next_.tissue.u;
  std::optional<std::pair<State, cavity::Shape>> from;  // to begin again with the other tangent
  if (tissue.tangent().exact()) from.emplace(next_, walls_);
  for (;;) {
    auto solution = solve::attempted([&] { return solve_once(); });
    if (solution) {
      solution_ = std::move(*solution);
      break;
    }
    // As a tangent without factor: a smaller step, or the other tangent, may do.
    const core::Refusal& refusal = solution.refusal();
    const bool exact = tissue.tangent().exact();
    if (tissue.tangent().drop_exact()) {
      std::tie(next_, walls_) = *from;
      continue;
    }
    if (refusal.unsolved && !exact) throw core::Unsolved(refusal.why);
    if (refusal.unsolved)
      return core::Refusal{
          "the exact tangent was not solved with (an instability, or too large a step): " +
          refusal.why};
    return refusal;
  }
  ++report_.linearisations;
  const tissue::Folded folded = tissue.folded(next_.tissue.u);
  inverted_ = refused(folded);
  if (model_->scene.tissue.allow_inversion) report_.folded = folded.linear;
  for (const needle::NeedleState& needle : next_.needles)
    if (!needle.finite()) return core::Refusal{"a needle's shape is not finite"};
  return core::Done{};
}

core::Outcome<Solution> Newton::solve_once()
{
  const core::TimeStep& now = scheme_->now();
  fem::Load load;
  if (model_->cavities) load = model_->cavities->load(next_.cavities, walls_, now);
  auto at = model_->tissue.linearise(scheme_->past().tissue, next_.tissue.u, now, load,
                                     report_.linearisations > 0);  // 2 each body alone
  if (!at) return at.refusal();
  // Directions frozen at the start of the step, as in the paper, or brought up to date within it.
  const int most = model_->scene.time.direction_max;
  for (int turn = 1;; ++turn) {
    at->iterate = next_.tissue.u;  // where the gaps are measured from
    auto solution = solve_rows(*at);
    if (!solution) return solution.refusal();
    walls_ = model_->walls(next_.tissue.u);
    if (solution->system.empty() || turn == most ||
        gaps_closed(*model_, *solution, coupling_rows(*model_, now, next_)))
      return solution;
    solution_ = std::move(*solution);
  }
}

/// 3: the rows where the state so far has them, and the bodies they hold.
void Newton::collect_rows(Solution& solution)
{
  const core::TimeStep& now = scheme_->now();
  std::vector<constraint::SmallBody> bodies;
  for (std::size_t i = 0; i < model_->needles.size(); ++i) {
    solution.needles.push_back(
        model_->needles[i].linearise(scheme_->past().needles[i], next_.needles[i], now));
    const needle::Linearised& needle = solution.needles.back();
    bodies.push_back({needle.held, needle.factor, needle.free_increment});
  }
  Rows rows = coupling_rows(*model_, now, next_);
  solution.of_needle = std::move(rows.of_needle);
  if (model_->cavities)
    solution.of_cavities = cavity::add_rows(*model_->cavities, next_.cavities,
                                            {next_.tissue.u, walls_, now}, rows.set);
  solution.system = constraint::System(std::move(rows.set), std::move(bodies));
}

core::Outcome<Solution> Newton::solve_rows(solve::Linearisation& at)
{
  Solution solution;
  collect_rows(solution);
  if (model_->cavities)
    solution.system.relinearise = [&](const core::VecX& lambda, constraint::Set& set) {
      return cavity::refresh(*model_->cavities, lambda, solution.of_cavities, set);
    };
  solution.system.place = [&](int row) { return place_of(model_->scene, solution, row); };
  auto saddle = meet_laws(at, solution.system);  // 4
  solution.system.relinearise = nullptr;         // they look at this very solution
  solution.system.place = nullptr;
  if (!saddle) return saddle.refusal();
  solution.saddle = std::move(*saddle);
  if (!solution.system.empty()) solution.mobility = law::mobility(solution.saddle.problem);
  correct(solution);
  return solution;
}

/// 4: the dense problem, and where it leads the tissue.
core::Outcome<constraint::Saddle> Newton::meet_laws(solve::Linearisation& at,
                                                    constraint::System& system)
{
  const bool known = solution_ && solution_->lambda().size() == system.size();
  const core::VecX start = known ? solution_->lambda() : system.starts();
  const constraint::LawSettings settings{model_->scene.laws, model_->scene.compare,
                                         &model_->ledger};
  constraint::Laws laws(system, settings, report_);
  if (!model_->cavities || cavity::frozen(*model_->cavities, next_.cavities).empty())
    return constraint::solve_saddle(laws, at, start,
                                    {model_->scene.tissue.reuse == solve::Reuse::stale,
                                     model_->scene.stale_error, lag_tolerance(!system.empty())});
  auto saddle = model_->pressure_search->solve(laws, at, start, scheme_->now(), next_.cavities);
  report_.pressure_updates = std::max(report_.pressure_updates, model_->pressure_search->updates());
  return saddle;
}

/// 5: every body goes where the multipliers lead it.
void Newton::correct(Solution& solution)
{
  const core::TimeStep& now = scheme_->now();
  const State& past = scheme_->past();
  next_.tissue.u = std::move(solution.saddle.u);
  next_.tissue.v.value = now.rates().velocity * (next_.tissue.u.value - past.tissue.u.value);
  if (model_->cavities)
    cavity::take_pressures(*model_->cavities, solution.of_cavities, solution.lambda(), now,
                           next_.cavities);
  report_.needles.assign(model_->needles.size(), {});
  for (std::size_t i = 0; i < model_->needles.size(); ++i) {
    const needle::Needle& needle = model_->needles[i];
    const core::VecX lever = solution.on_needle(i);
    report_.needles[i].base = needle.base_wrench(next_.needles[i], solution.needles[i], lever);
    next_.needles[i] =
        needle.correct(past.needles[i], next_.needles[i], solution.needles[i], lever, now);
  }
}

/// Of a step that is iterated anyway, a linearisation need only lead on: beside forces of rows,
/// well beyond what the last one left, or one sweep with an older factor would pass for it again
/// and again and lead nowhere. Under pressures that follow it does so by the square of that, so
/// that Newton's rate is kept.
double Newton::lag_tolerance(bool rows) const
{
  constexpr double least = 1e-10, part = 0.1;
  const bool follows = model_->follows();
  const int told = model_->scene.time.newton_max;
  const bool goes_on = told == 0 && report_.linearisations > 0;
  const bool iterated = scheme_->now().is_static || told > 1 || goes_on;
  const double lag = model_->scene.tissue.lag_tolerance;
  const double leads_on = follows ? 1e-4 : std::max(lag, iterated ? 1e-4 : 0.0);
  if (!(follows || (iterated && rows)) || !std::isfinite(residual_)) return leads_on;
  return std::clamp(follows ? residual_ * residual_ : part * residual_, least, leads_on);
}

}  // namespace trocar::step
