#include "cavity/pressure_search.hpp"

#include <string>

namespace trocar::cavity {

/// Responses of the tissue alone to a unit pressure in each frozen cavity, made once per operator.
const PressureResponses& PressureSearch::unit_pressure_responses(const State& state,
                                                                 const TimeStep& now,
                                                                 solve::LaggedFactor& factor)
{
  constexpr std::size_t most_kept = 2;
  const std::vector<int> which = frozen(*cavities_, state);
  const auto known = responses_.find(now.operator_rates());
  // The number of responses grows when a cavity with a given pressure at the start joins the
  // search.
  if (known != responses_.end() && known->second.per_p.size() == which.size()) return known->second;
  if (responses_.size() == most_kept) responses_.clear();
  PressureResponses answers{{}, VecX::Zero(static_cast<Eigen::Index>(which.size()))};
  for (std::size_t k = 0; k < which.size(); ++k) {
    answers.per_p.push_back(factor.answer(cavities_->unit_load(which[k])));
    double& gain = answers.gain[static_cast<Eigen::Index>(k)];
    gain = cavities_->one(which[k]).gain;
    if (proportional(*cavities_) && gain == 0.0)
      gain = line_gain(*cavities_, which[k], answers.per_p.back());
  }
  return responses_[now.operator_rates()] = std::move(answers);
}

/// Responses with rows: w̃ = w + A⁻¹Hᵀ ∂λ/∂p, where rows that hold go on holding.
PressureResponses PressureSearch::with_rows(const constraint::Laws& laws,
                                            const PressureResponses& alone,
                                            solve::LaggedFactor& factor) const
{
  PressureResponses answers = alone;
  const constraint::System& system = laws.system();
  if (system.empty() || proportional(*cavities_)) return answers;
  for (OwnedField& w : answers.per_p) {
    const VecX moved = system.row_displacements(solve::read(system.probes(), w, factor.space()));
    const VecX more =
        law::response(laws.problem(), laws.multipliers(), moved, laws.settings().solver.tolerance);
    w.value += factor.answer(system.forces(more, factor.space())).value;
  }
  return answers;
}

core::Outcome<constraint::Saddle> PressureSearch::solve(constraint::Laws& laws,
                                                        solve::Linearisation& at, const VecX& start,
                                                        const TimeStep& now, State& state)
{
  const constraint::System& system = laws.system();
  const OwnedField free = at.alone();
  const PressureResponses& alone = unit_pressure_responses(state, now, *at.factor);
  const std::vector<int> which = frozen(*cavities_, state);
  take_pressures(*cavities_, {}, {}, now, state);
  for (updates_ = 0;; ++updates_) {
    const VecX p = pressures(state)(which);
    OwnedField u = free;  // becomes free + Σ p A⁻¹g_0 + A⁻¹Hᵀλ
    for (std::size_t k = 0; k < alone.per_p.size(); ++k)
      u.value += p[static_cast<Eigen::Index>(k)] * alone.per_p[k].value;
    if (!system.empty()) {
      const OwnedField moved{u.value - at.iterate.value};
      const VecX at_probes = solve::read(system.probes(), moved, at.space());
      if (const auto met = laws.meet(*at.factor, at_probes, start); !met) return met.refusal();
      u.value += at.factor->answer(system.forces(laws.multipliers(), at.space())).value;
    }
    ++laws.report().passes;
    const Shape shape = cavities_->shape(u);
    if (closed(*cavities_, state, shape, now))
      return constraint::Saddle{std::move(u), laws.take(), laws.problem()};
    if (updates_ == most_updates(*cavities_))
      return core::Refusal{"the volumes of the cavities are not reached in " +
                           std::to_string(updates_) + " updates of the pressure"};
    const auto next =
        next_pressures(*cavities_, state, shape, with_rows(laws, alone, *at.factor), now);
    if (!next) return next.refusal();
    set_pressures(which, *next, state);
    ++ledger_->pressure_updates;
  }
}

}  // namespace trocar::cavity
