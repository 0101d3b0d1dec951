#include "step/rows.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::step {

Rows coupling_rows(const Model& model, const core::TimeStep& now, const State& state)
{
  Rows rows;
  const bool coupled = std::any_of(state.insertions.begin(), state.insertions.end(),
                                   [](const auto& one) { return one.touches(); });
  if (!coupled) return rows;
  const fem::GlobalField u = model.space.gather(state.tissue.u);
  const insertion::Deformed tissue(model.scene.mesh, *model.locator, u);
  const double passing = now.start ? 0.0 : now.h;
  for (std::size_t i = 0; i < model.needles.size(); ++i) {
    const insertion::Iterate at{state.needles[i].shaft, tissue, static_cast<int>(i), passing};
    rows.of_needle.push_back(insertion::add_rows(*model.ground, state.insertions[i], at, rows.set));
  }
  return rows;
}

fem::OwnedField Solution::needle_forces(const fem::Space& space) const
{
  if (system.empty()) return space.zero();
  const solve::Probes& probes = system.probes();
  core::VecX of_needles = lambda();
  of_needles.segment(of_contact.first, of_contact.count).setZero();
  core::VecX forces = system.probe_forces(of_needles);
  forces.tail(static_cast<Eigen::Index>(probes.wide.size())).setZero();
  return solve::spread(probes, forces, space);
}

fem::OwnedField Solution::forces(const Model& model, const State& state, const cavity::Shape& walls,
                                 const core::TimeStep& now) const
{
  fem::OwnedField forces = needle_forces(model.space);
  // Contact pushes along the normals that the bodies have now, at the places that they touch now.
  if (contact) forces.value += contact->system.forces(contact->lambda, model.space).value;
  if (model.cavities) forces.value += model.cavities->forces(state.cavities, walls, now).value;
  return forces;
}

namespace {

/// Largest gap of a row that counts as closed [m]. The floor of 1e-12 m is the accuracy of places,
/// which are known to a part in 1e14.
double closed_gap(const Model& model)
{
  constexpr double no_gap = 1e-12;
  return std::max(10.0 * model.scene.laws.tolerance, no_gap);
}

}  // namespace

double contact_tolerance(const Model& model)
{
  return closed_gap(model);
}

namespace {

/// What the couplings between rows of needles add to their gaps under λ [m].
core::VecX yielded(const constraint::Set& set, const core::VecX& lambda)
{
  core::VecX gap = core::VecX::Zero(set.size());
  for (const constraint::Set::Coupling& c : set.couplings()) {
    if (set.rows()[static_cast<std::size_t>(c.i)].body < 0) continue;
    gap[c.i] += c.compliance * lambda[c.j];
    if (c.i != c.j) gap[c.j] += c.compliance * lambda[c.i];
  }
  return gap;
}

}  // namespace

bool gaps_closed(const Model& model, const Solution& solution, const Rows& here)
{
  const core::VecX soft = yielded(here.set, solution.lambda());
  for (const law::Block& block : here.set.blocks()) {
    const constraint::Row& row = here.set.rows()[static_cast<std::size_t>(block.first)];
    const bool hard = block.law.set == law::Law::Set::zero && row.compliance == 0.0 &&
                      row.relative_compliance == 0.0 && solution.mobility[block.first] > 0.0;
    if (hard && std::abs(row.gap + soft[block.first]) > closed_gap(model)) return false;
  }
  return true;
}

namespace {

/// Increment by which needle i would answer its residual at `state`, with the factor of the last
/// linearisation [m, rad].
core::VecX next_increment(const Model& model, const Scheme& scheme, const State& state,
                          const Solution& solution, std::size_t i)
{
  const needle::Linearised& linear = solution.needles[i];
  const Eigen::Index dofs = linear.free_increment.size();
  core::VecX d = core::VecX::Zero(linear.held + dofs);
  if (dofs == 0) return d;
  const core::VecX r =
      model.needles[i].residual(scheme.past().needles[i], state.needles[i], scheme.now()) -
      solution.on_needle(i);
  d.tail(dofs) = linear.factor.solve(core::VecX(r.tail(dofs)));
  return d;
}

}  // namespace

// Measures the gaps of the lateral rows in the new geometry, changed by the increments with which
// the beams would answer their residuals. A gap over W_ii is the force that would close it. The
// residuals themselves are no measure: along a stiff beam a displacement far below the gaps is a
// huge force, which no other body feels.
double left_across(const Model& model, const Scheme& scheme, const State& state,
                   const Solution& solution, const Rows& here)
{
  std::vector<core::VecX> d;
  for (std::size_t i = 0; i < model.needles.size(); ++i)
    d.push_back(next_increment(model, scheme, state, solution, i));
  const core::VecX& lambda = solution.lambda();
  const core::VecX soft = yielded(here.set, lambda);
  std::vector<double> largest(model.needles.size(), 0.0), change = largest;  // by needle [N]
  for (const law::Block& block : here.set.blocks()) {
    const int i = block.first;
    const constraint::Row& row = here.set.rows()[static_cast<std::size_t>(i)];
    const bool across = row.body >= 0 && block.law.set == law::Law::Set::zero &&
                        row.relative_compliance == 0.0 && solution.mobility[i] > 0.0;
    if (!across) continue;
    const auto b = static_cast<std::size_t>(row.body);
    double gap = row.gap + row.compliance * lambda[i] + soft[i];
    for (const auto& [dof, coefficient] : row.on_body) gap -= coefficient * d[b][dof];
    const double open = std::max(std::abs(gap) - closed_gap(model), 0.0);
    largest[b] = std::max(largest[b], std::abs(lambda[i]));
    change[b] = std::max(change[b], open / solution.mobility[i]);
  }
  double worst = 0.0;
  for (std::size_t b = 0; b < change.size(); ++b)
    if (change[b] > 0.0) worst = std::max(worst, change[b] / (largest[b] + change[b]));
  return worst;
}

}  // namespace trocar::step
