#include <algorithm>
#include <string>
#include <vector>

#include "law/solve.hpp"
#include "step/simulation.hpp"

// What cavities do in a step beside their rows: forces, and the frozen model's search for pressures
// around the laws of all other rows.
namespace trocar::step {

/// Walls where the state has them: looked at once for every place of the tissue, and only when some
/// load or volume is theirs.
cavity::Shape Simulation::walls_of(const State& state) const
{
  return cavities_ && cavities_->exact() ? cavities_->shape(state.tissue.u) : cavity::Shape{};
}

/// Hᵀλ of the rows that are not cavities [N].
fem::OwnedField Simulation::needle_forces(const Pass& pass) const
{
  if (pass.lambda.lambda.size() == 0) return space_.zero();
  core::VecX forces = pass.forces;
  forces.tail(static_cast<Eigen::Index>(pass.probes.wide.size())).setZero();
  return solve::spread(pass.probes, forces, space_);
}

/// Forces of needles and cavities on the tissue where it is now [N].
fem::OwnedField Simulation::all_forces(const Pass& pass, const State& next,
                                       const cavity::Shape& walls, const core::TimeStep& now) const
{
  fem::OwnedField forces = needle_forces(pass);
  if (cavities_) forces.value += cavities_->forces(next.cavities, walls, now).value;
  return forces;
}

/// How the tissue alone answers to the pressure of every frozen cavity, once for each operator.
const cavity::PressureAnswers& Simulation::unit_answers(const cavity::State& state,
                                                        const core::TimeStep& now)
{
  constexpr std::size_t most_kept = 2;
  const std::vector<int> which = cavities_->frozen(state);
  const auto known = unit_answers_.find(now.rates());
  // Pressures that are given at the start only join later.
  if (known != unit_answers_.end() && known->second.per_p.size() == which.size())
    return known->second;
  if (unit_answers_.size() == most_kept) unit_answers_.clear();
  cavity::PressureAnswers answers{{}, core::VecX::Zero(static_cast<Eigen::Index>(which.size()))};
  for (std::size_t k = 0; k < which.size(); ++k) {
    answers.per_p.push_back(tissue_.answer(cavities_->unit_load(which[k])));
    double& gain = answers.gain[static_cast<Eigen::Index>(k)];
    gain = cavities_->settings().cavities[static_cast<std::size_t>(which[k])].gain;
    if (cavities_->proportional() && gain == 0.0)
      gain = cavities_->line_gain(which[k], answers.per_p.back());
  }
  return unit_answers_[now.rates()] = std::move(answers);
}

/// The same when rows that hold go on holding: w̃ = w + A⁻¹Hᵀ ∂λ/∂p.
cavity::PressureAnswers Simulation::answers_with_rows(const Pass& pass,
                                                      const cavity::PressureAnswers& alone)
{
  cavity::PressureAnswers answers = alone;
  if (pass.rows.set.empty() || cavities_->proportional()) return answers;
  for (fem::OwnedField& w : answers.per_p) {
    const core::VecX moved =
        constraint::row_displacements(pass.rows.set, solve::read(pass.probes, w, space_));
    const core::VecX more = law::response(pass.problem, pass.lambda.lambda, moved);
    const core::VecX forces = constraint::probe_forces(pass.rows.set, more);
    w.value += tissue_.answer(solve::spread(pass.probes, forces, space_)).value;
  }
  return answers;
}

/// u = u_free + A⁻¹Hᵀλ + Σ p A⁻¹g_0 for these pressures, λ in the laws.
void Simulation::at_pressures(const fem::OwnedField& free,
                              const std::vector<fem::OwnedField>& per_p,
                              const fem::OwnedField& start, const core::VecX& last, Pass& pass,
                              State& next, StepReport& report)
{
  const core::VecX p = cavities_->pressures(next.cavities)(cavities_->frozen(next.cavities));
  fem::OwnedField u = free;
  for (std::size_t k = 0; k < per_p.size(); ++k)
    u.value += p[static_cast<Eigen::Index>(k)] * per_p[k].value;
  if (!pass.rows.set.empty()) {
    const core::VecX at_probes = solve::read(pass.probes, {u.value - start.value}, space_);
    pass.trouble = solve_constraints(at_probes, last, pass, report);
    if (pass.trouble) return;
    u.value += tissue_.answer(solve::spread(pass.probes, pass.forces, space_)).value;
  }
  next.tissue.u = std::move(u);
  ++report.passes;
}

/// The pressures of frozen cavities are updated until their volumes are those of their fluids.
void Simulation::meet_frozen_laws(const core::TimeStep& now, const tissue::FreeMotion& tissue,
                                  const core::VecX& last, Pass& pass, State& next,
                                  StepReport& report)
{
  const fem::OwnedField start = next.tissue.u;
  const fem::OwnedField free = tissue_.finish(tissue, {}, {});
  const cavity::PressureAnswers& alone = unit_answers(next.cavities, now);
  const std::vector<int> which = cavities_->frozen(next.cavities);
  if (!pass.rows.set.empty()) get_compliance(pass, report);
  cavities_->take({}, {}, now, next.cavities);
  for (int updates = 0;; ++updates) {
    at_pressures(free, alone.per_p, start, last, pass, next, report);
    if (pass.trouble) return;
    report.pressure_updates = std::max(report.pressure_updates, updates);
    const cavity::Shape shape = cavities_->shape(next.tissue.u);
    if (cavities_->closed(next.cavities, shape, now)) return;
    if (updates == cavities_->most_updates()) {
      pass.trouble = "the volumes of the cavities are not reached in " + std::to_string(updates) +
                     " updates of the pressure";
      return;
    }
    const cavity::NextPressures pressures =
        cavities_->next_pressures(next.cavities, shape, answers_with_rows(pass, alone), now);
    pass.trouble = pressures.trouble;
    if (pass.trouble) return;
    cavities_->set_pressures(which, pressures.p, next.cavities);
    ++ledger_.pressure_updates;
  }
}

}  // namespace trocar::step
