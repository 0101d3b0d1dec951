#include "driver/simulation.hpp"
#include "law/solve.hpp"

// What cavities do in a step beside their rows: forces, and the frozen model's search for pressures
// around the laws of all other rows.
namespace trocar::driver {

/// Walls where the state has them; nothing looks at them when no pressure follows.
cavity::Shape Simulation::walls(const State& state) const
{
  return cavities_->follows() ? cavities_->shape(state.tissue.u) : cavity::Shape{};
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
                                       const core::TimeStep& now) const
{
  fem::OwnedField forces = needle_forces(pass);
  if (cavities_) forces.value += cavities_->forces(next.cavities, walls(next), now).value;
  return forces;
}

/// Displacement per unit pressure of every frozen cavity [m/Pa], once for each operator.
const std::vector<fem::OwnedField>& Simulation::unit_answers(const cavity::State& state,
                                                             const core::TimeStep& now)
{
  constexpr std::size_t most_kept = 2;
  const std::vector<int> which = cavities_->frozen(state);
  const auto known = unit_answers_.find(now.inverse());
  // Pressures that are given at the start only join later.
  if (known != unit_answers_.end() && known->second.size() == which.size()) return known->second;
  if (unit_answers_.size() == most_kept) unit_answers_.clear();
  std::vector<fem::OwnedField>& answers = unit_answers_[now.inverse()];
  answers.clear();
  for (int cavity : which) answers.push_back(tissue_.answer(cavities_->unit_load(cavity)));
  return answers;
}

/// Displacement per unit pressure when rows that hold go on holding: w̃ = w + A⁻¹Hᵀ ∂λ/∂p.
std::vector<fem::OwnedField> Simulation::answers_with_rows(
    const Pass& pass, const std::vector<fem::OwnedField>& per_p)
{
  std::vector<fem::OwnedField> answers = per_p;
  if (pass.rows.set.empty()) return answers;
  for (fem::OwnedField& w : answers) {
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
  const std::vector<int> which = cavities_->frozen(next.cavities);
  fem::OwnedField u = free;
  for (std::size_t k = 0; k < which.size(); ++k)
    u.value += cavities_->pressures(next.cavities)[which[k]] * per_p[k].value;
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
  const std::vector<fem::OwnedField>& per_p = unit_answers(next.cavities, now);
  const std::vector<int> which = cavities_->frozen(next.cavities);
  if (!pass.rows.set.empty()) get_compliance(pass, report);
  for (std::size_t k = 0; cavities_->proportional() && k < which.size(); ++k)
    if (cavities_->gain(which[k]) == 0.0)
      cavities_->set_gain(which[k], cavities_->line_gain(which[k], per_p[k]));
  cavities_->take({}, {}, now, next.cavities);
  for (int updates = 0;; ++updates) {
    at_pressures(free, per_p, start, last, pass, next, report);
    if (pass.trouble) return;
    report.pressure_updates = updates;
    const cavity::Shape shape = cavities_->shape(next.tissue.u);
    if (cavities_->closed(next.cavities, shape, now)) return;
    if (updates == cavities_->most_updates()) {
      pass.trouble = "the volumes of the cavities are not reached in " + std::to_string(updates) +
                     " updates of the pressure";
      return;
    }
    std::vector<fem::OwnedField> answers;
    if (!cavities_->proportional()) answers = answers_with_rows(pass, per_p);
    const cavity::NextPressures pressures =
        cavities_->next_pressures(next.cavities, shape, answers, now);
    pass.trouble = pressures.trouble;
    if (pass.trouble) return;
    cavities_->set_pressures(which, pressures.p, next.cavities);
    ++ledger_.pressure_updates;
  }
}

}  // namespace trocar::driver
