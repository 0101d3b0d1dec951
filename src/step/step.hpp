#pragma once

#include "core/outcome.hpp"
#include "step/model.hpp"
#include "step/report.hpp"

namespace trocar::step {

using core::Outcome;

/// A step that was taken.
struct Accepted
{
  State state;
  StepReport report;
};

/// One step from `old`, or why it cannot be taken; agreed by all ranks. The old state is not
/// touched. Collective.
Outcome<Accepted> advance(Model& model, const State& old, const core::TimeStep& step);

/// State before the first step: at rest, or in equilibrium with the loads; inserted needles are
/// coupled on the undeformed mesh first. Collective.
Outcome<Accepted> initial_state(Model& model);

/// Static equilibrium at `now.t`; that of the start with load steps when one does not do.
/// Collective.
Outcome<Accepted> equilibrium(Model& model, const State& old, const core::TimeStep& now);

/// Factors the first operator, for -check. Collective.
void prepare(Model& model);

}  // namespace trocar::step
