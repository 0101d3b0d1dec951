#include "step/accept.hpp"

#include <algorithm>

#include "cavity/network.hpp"
#include "insertion/channel.hpp"
#include "insertion/tip_events.hpp"
#include "step/refusals.hpp"

namespace trocar::step {
namespace {

// Energy account at the end of a step [J]. A row dissipates -λ·δ where it slips. All other work of
// a row passes from the needle to the tissue and cancels in the account.
EnergyAccount account(const Model& model, const State& old, const Scheme& scheme, Newton& newton)
{
  const core::TimeStep& now = scheme.now();
  const State& next = newton.state();
  const tissue::Work tissue =
      model.tissue.work(old.tissue, scheme.past().tissue, next.tissue, now,
                        newton.solution().forces(model, next, newton.walls(), now));
  EnergyAccount energy = old.energy;
  energy.elastic = tissue.elastic;
  energy.kinetic = tissue.kinetic;
  energy.supplied += tissue.supplied;
  if (model.cavities)  // work of the fluids' pressures
    energy.supplied += model.space.dot(model.cavities->forces(next.cavities, newton.walls(), now),
                                       {next.tissue.u.value - old.tissue.u.value});
  energy.damping += tissue.damped;
  for (std::size_t i = 0; i < model.needles.size(); ++i) {
    const needle::Energy needle = model.needles[i].energy(old.needles[i], next.needles[i]);
    energy.elastic += needle.elastic;
    energy.kinetic += needle.kinetic;
    const NeedleReport& done = newton.report().needles[i];
    const needle::Shaft& from = old.needles[i].shaft;
    const needle::Shaft& to = next.needles[i].shaft;
    const Vec3 turn = core::rotation_log(to.R.front() * from.R.front().transpose());
    energy.supplied += needle.weight + done.base.force.dot(to.x.front() - from.x.front()) +
                       done.base.moment.dot(turn);
    energy.friction -= done.coupling.friction_work;
    energy.cutting -= done.coupling.cutting_work;
  }
  for (const contact::PairReport& pair : newton.report().contact) {
    energy.supplied += pair.obstacle_work;
    energy.contact -= pair.normal_work;
    energy.contact_friction -= pair.friction_work;
  }
  // At the start all sums are zero, and the stored energy is kept as `stored_at_start`.
  if (now.start) {
    const double stored = energy.elastic + energy.kinetic;
    energy = {energy.elastic, energy.kinetic, stored};
  }
  return energy;
}

void accept_cavities(const Model& model, const core::TimeStep& now, Newton& newton)
{
  const cavity::Cavities& cavities = *model.cavities;
  State& next = newton.state();
  StepReport& report = newton.report();
  const cavity::Shape shape = cavities.exact() ? newton.walls() : cavities.shape(next.tissue.u);
  report.cavities = cavity::accept(cavities, {next.tissue.u, shape, now}, next.cavities);
  for (cavity::CavityReport& cavity : report.cavities)
    cavity.iterations = std::max(report.linearisations, report.pressure_updates);
}

void accept_contact(const Model& model, const State& old, double begin, Newton& newton)
{
  State& next = newton.state();
  StepReport& report = newton.report();
  report.contact.assign(model.contact.size(), {});
  for (contact::PairState& pair : next.contact.pairs) pair.touches.clear();
  if (!newton.solution().contact) return;
  const fem::GlobalField u = model.space.gather(next.tissue.u);
  const fem::GlobalField before = model.space.gather(old.tissue.u);
  next.contact = contact::accept({model.contact, old.contact, before, begin},
                                 *newton.solution().contact, {model.scene.mesh, u, next.t},
                                 model.scene.insertion.stick_tolerance, report.contact);
}

void accept_needles(const Model& model, Newton& newton)
{
  const Solution& solution = newton.solution();
  State& next = newton.state();
  std::optional<fem::GlobalField> u;  // gathered only when some tip does not hold
  for (std::size_t i = 0; i < model.needles.size(); ++i) {
    NeedleReport& needle = newton.report().needles[i];
    const needle::Shaft& shaft = next.needles[i].shaft;
    if (!solution.of_needle.empty())
      needle.coupling = insertion::accept(*model.ground, next.insertions[i], solution.of_needle[i],
                                          solution.saddle.multipliers);
    if (needle.coupling.tip != insertion::TipOutcome::holds) {
      if (!u) u = model.space.gather(next.tissue.u);
      insertion::settle_tip(*model.ground, next.insertions[i], needle.coupling, shaft,
                            {model.scene.mesh, *model.locator, *u});
    }
    needle.tip = shaft.tip();
    needle.depth = insertion::depth(next.insertions[i]);
  }
}

}  // namespace

Outcome<Accepted> accept(const Model& model, const State& old, const Scheme& scheme, Newton& newton)
{
  const core::TimeStep& now = scheme.now();
  if (auto refusal = cannot_stand(model.scene, now, newton.balance())) return std::move(*refusal);
  State& next = newton.state();
  StepReport& report = newton.report();
  const tissue::BoundaryConditions& boundary = model.scene.tissue.boundary;
  if (!boundary.displacements.empty() || !boundary.fixed.empty())
    report.holders =
        model.tissue.reactions(scheme.past().tissue, next.tissue.u, now,
                               newton.solution().forces(model, next, newton.walls(), now));
  if (model.cavities) accept_cavities(model, now, newton);
  if (!model.contact.empty()) accept_contact(model, old, now.begin(), newton);
  accept_needles(model, newton);
  model.tissue.remember_factor(next.tissue);
  if (model.scene.time.second_order && !now.start)
    next.before = PreviousStep{scheme.old_velocity(), {old.tissue.u, old.tissue.v}, old.needles};
  if (model.scene.energy) next.energy = account(model, old, scheme, newton);
  if (auto refusal = collapsed(model.scene, report)) return std::move(*refusal);
  return Accepted{std::move(next), std::move(report)};
}

}  // namespace trocar::step
