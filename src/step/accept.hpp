#pragma once

#include "step/newton.hpp"
#include "step/step.hpp"

namespace trocar::step {

/// Ends a step that is balanced: what happened is booked into the state, and told. Refused when
/// such a state must not be. Collective.
Outcome<Accepted> accept(const Model& model, const State& old, const Scheme& scheme,
                         Newton& newton);

}  // namespace trocar::step
