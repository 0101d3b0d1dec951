#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "law/immovable.hpp"
#include "step/newton.hpp"
#include "step/refusals.hpp"

// Parts 2 to 5 of a step: the free motion of every body (2), the rows (3), the dense problem (4)
// and the correction of the bodies (5). Part 1 is in events.cpp.
namespace trocar::step {

core::Outcome<core::Done> Newton::linearise()
{
  tissue::Tissue& tissue = model_->tissue;
  u_before_ = next_.tissue.u;
  std::optional<std::pair<State, cavity::Shape>> from;  // for a retry with the rotated tangent
  if (tissue.tangent().exact()) from.emplace(next_, walls_);
  for (;;) {
    auto solution = solve::attempted([&] { return solve_once(); });
    if (solution) {
      solution_ = std::move(*solution);
      break;
    }
    // An exact tangent that fails may be indefinite. An automatic choice then takes the rotated
    // tangent, otherwise the step is refused, as a smaller step may succeed. With any other tangent
    // a linear system that is not solved ends the run.
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
                                     report_.linearisations > 0);  // part 2: the tissue
  if (!at) return at.refusal();
  // With direction_max 1 the rows keep the directions of the iterate, as in the paper. With more,
  // the rows are made again at every solution until their gaps are closed, or `most` is reached.
  const int most = model_->scene.time.direction_max;
  for (int turn = 1;; ++turn) {
    at->iterate = next_.tissue.u;  // displacement at which the gaps are evaluated
    auto solution = solve_rows(*at);
    if (!solution) return solution.refusal();
    walls_ = model_->walls(next_.tissue.u);
    if (solution->system.empty() || turn == most ||
        gaps_closed(*model_, *solution, coupling_rows(*model_, now, next_)))
      return solution;
    solution_ = std::move(*solution);
  }
}

/// Part 3: makes the rows at the present iterate. Also does part 2 for the needles.
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
  if (!model_->contact.empty()) {
    const fem::GlobalField u = model_->space.gather(next_.tissue.u);
    solution.of_contact = contact::add_rows(contacts(), {model_->scene.mesh, u, now.t}, rows.set);
    model_->ledger.contact_queries += solution.of_contact.queries;
  }
  solution.system = constraint::System(std::move(rows.set), std::move(bodies));
}

/// Rows and forces of contact in the geometry that the linearisation led to.
void Newton::end_contact(Solution& solution) const
{
  const fem::GlobalField u = model_->space.gather(next_.tissue.u);
  const contact::Deformation now{model_->scene.mesh, u, scheme_->now().t};
  const std::vector<contact::Pair>& pairs = model_->contact;
  const bool any = std::any_of(pairs.begin(), pairs.end(),
                               [&](const contact::Pair& pair) { return contact::near(pair, now); });
  if (!any && solution.of_contact.groups.empty()) return;
  solution.contact =
      contact::ending(contacts(), now, solution.of_contact, solution.lambda(), solution.mobility);
  model_->ledger.contact_queries += solution.contact->rows.queries;
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
  auto saddle = meet_laws(at, solution.system);  // part 4: the dense problem
  solution.system.relinearise = nullptr;         // both functions capture local variables
  solution.system.place = nullptr;
  if (!saddle) return saddle.refusal();
  solution.saddle = std::move(*saddle);
  if (!solution.system.empty()) solution.mobility = law::mobility(solution.saddle.problem);
  correct(solution);
  if (!model_->contact.empty()) end_contact(solution);
  return solution;
}

/// Part 4: solves the dense problem for the multipliers, and the tissue for its displacement under
/// these multipliers. With frozen cavities the search for their pressures does both.
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

/// Part 5: moves tissue and needles to the solution, and sets velocities and pressures.
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

/// Relative residual to which one linearisation is solved. 1e-4 is enough in a step that is
/// iterated. With rows it is a tenth of the residual that the last linearisation left, if that is
/// smaller. Under a looser tolerance one sweep with an older factor would be accepted again and
/// again without progress. With loads that follow the tissue it is the square of the last residual,
/// which keeps Newton's rate.
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
