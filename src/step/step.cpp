#include "step/step.hpp"

#include <array>

#include "cavity/rows.hpp"
#include "insertion/channel.hpp"
#include "step/accept.hpp"
#include "step/events.hpp"
#include "step/newton.hpp"

namespace trocar::step {
namespace {

// A step as in both papers. Every body moves freely (part 2). The rows that couple the bodies (3)
// are solved in one small dense problem (4). Its multipliers correct the bodies (5). Parts 2 to 5
// are repeated until all forces are balanced.
Outcome<Accepted> advance_by(Model& model, const State& old, const Scheme& scheme)
{
  auto next = predict(model, old, scheme);  // part 1: events, fixed from here on
  if (!next) return next.refusal();
  Newton newton(model, scheme, std::move(*next));
  while (newton.goes_on()) {
    if (const auto solved = newton.linearise(); !solved) return solved.refusal();  // parts 2 to 5
    if (newton.balanced()) return accept(model, old, scheme, newton);
    if (const auto led = newton.lead_on(); !led) return led.refusal();
  }
  return newton.not_balanced();
}

/// A static step. The exact tangent of a body that contact alone holds may be indefinite under its
/// load, because it does not know what contact bears: then with more of the proximal term, which
/// comes to rest more slowly.
Outcome<Accepted> advance_static(Model& model, const State& old, core::TimeStep step)
{
  constexpr std::array shares{1.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 1e5};
  for (std::size_t k = 0;; ++k) {
    step.proximal = shares[k] * model.proximal;
    Outcome<Accepted> end = advance_by(model, old, Scheme(model, old, step));
    const bool again = !end && end.refusal().indefinite && step.proximal > 0.0;
    if (!again || k + 1 == shares.size()) return end;
  }
}

}  // namespace

// Where bodies meet or part, velocities jump, and a difference over three states overshoots: one
// impact becomes several. With BDF2 such a step is repeated with backward Euler, and BDF2 begins
// anew from its end.
Outcome<Accepted> advance(Model& model, const State& old, const core::TimeStep& step)
{
  if (step.is_static) return advance_static(model, old, step);
  const Scheme scheme(model, old, step);
  Outcome<Accepted> end = advance_by(model, old, scheme);
  if (!end || !model.scene.time.second_order) return end;
  if (contact::same_touching(old.contact, end->state.contact)) return end;
  if (scheme.second_order()) {
    ++model.ledger.repeated_steps;
    end = advance_by(model, old, Scheme(model, old, step, 1));
  }
  if (end) end->state.before.reset();
  return end;
}

Outcome<Accepted> initial_state(Model& model)
{
  State state;
  state.tissue = tissue::at_rest(model.space);
  for (const needle::Needle& needle : model.needles) {
    state.needles.push_back(needle.initial());
    state.insertions.push_back(insertion::start(*model.ground, needle));
  }
  if (model.cavities) state.cavities = cavity::start(*model.cavities);
  if (!model.contact.empty()) {
    const fem::GlobalField none = model.space.gather(state.tissue.u);
    state.contact = contact::start(model.contact, {model.scene.mesh, none}, model.ledger);
  }
  const TimeSettings& time = model.scene.time;
  const core::TimeStep start = core::TimeStep::at_start(time.step);
  if (time.start_in_equilibrium || time.is_static) return equilibrium(model, state, start);
  StepReport report;
  for (std::size_t i = 0; i < model.needles.size(); ++i)
    report.needles.push_back(
        {state.needles[i].shaft.tip(), insertion::depth(state.insertions[i]), {}, {}});
  if (model.cavities) {
    cavity::take_pressures(*model.cavities, {}, {}, start, state.cavities);
    const cavity::Shape shape = model.cavities->shape(state.tissue.u);
    report.cavities =
        cavity::accept(*model.cavities, {state.tissue.u, shape, start}, state.cavities);
  }
  report.contact.assign(model.contact.size(), {});
  const tissue::BoundaryConditions& boundary = model.scene.tissue.boundary;
  report.holders.tools.assign(boundary.displacements.size(), Vec3::Zero());
  report.holders.supports.assign(boundary.fixed.size(), Vec3::Zero());
  return Accepted{std::move(state), std::move(report)};
}

Outcome<Accepted> equilibrium(Model& model, const State& old, const core::TimeStep& now)
{
  constexpr int most_load_steps = 64;
  // Only the start is loaded in parts. Later equilibria are retried in half steps by TimeStepper.
  const int most_parts = now.start ? most_load_steps : 1;
  for (int parts = 1;; parts *= 2) {
    State from = old;
    for (int part = 1; part <= parts; ++part) {
      core::TimeStep share = now;
      share.load = static_cast<double>(part) / parts;
      Outcome<Accepted> result = advance(model, from, share);
      if (!result && 2 * parts > most_parts) return result;
      if (!result) break;
      if (part == parts) return result;
      from = std::move(result->state);
    }
  }
}

void prepare(Model& model)
{
  const bool is_static = model.scene.time.is_static || model.scene.time.start_in_equilibrium;
  const State none;
  const Scheme first(model, none, {0.0, model.scene.time.step, is_static});
  model.tissue.prepare(first.now());
}

}  // namespace trocar::step
