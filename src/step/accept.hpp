#pragma once

#include "step/newton.hpp"
#include "step/step.hpp"

namespace trocar::step {

/// Ends a balanced step: updates multipliers, tips, fluids and energies in the state, and completes
/// the report. Moves both out of `newton`. Refused for the reasons of `cannot_stand` and
/// `collapsed` (refusals.hpp). Collective.
Outcome<Accepted> accept(const Model& model, const State& old, const Scheme& scheme,
                         Newton& newton);

}  // namespace trocar::step
