#pragma once

#include "core/outcome.hpp"
#include "step/model.hpp"
#include "step/report.hpp"

namespace trocar::step {

using core::Outcome;

/// Result of an accepted step.
struct Accepted
{
  State state;
  StepReport report;
};

/// Takes one step from `old`, which stays unchanged. Refused, on all ranks alike, when the step
/// cannot be taken. Collective.
Outcome<Accepted> advance(Model& model, const State& old, const core::TimeStep& step);

/// State before the first step: at rest, or in equilibrium with the loads. Needles that start
/// inserted are coupled to the undeformed mesh before the equilibrium is solved. Collective.
Outcome<Accepted> initial_state(Model& model);

/// Static equilibrium at `now.t`. If the equilibrium of the start is not found at once, the loads
/// are applied in 2, 4, ... up to 64 load steps. Collective.
Outcome<Accepted> equilibrium(Model& model, const State& old, const core::TimeStep& now);

/// Factors the first operator, for `-check`. Throws Failure (70) when it has no factor. Collective.
void prepare(Model& model);

}  // namespace trocar::step
