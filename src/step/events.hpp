#pragma once

#include "step/scheme.hpp"

namespace trocar::step {

/// First iterate of a step, with the events of the step. Events are decided before the solve and do
/// not change during the solve. Every needle moves with its base to the end of the step. Its tip
/// goes through the tissue in the shape of the old state: the path grows, and coupling points are
/// born. Needles open conduits, and curves inject fluid. Refused when a shaft enters the tissue
/// beside its channel. Collective.
core::Outcome<State> predict(const Model& model, const State& old, const Scheme& scheme);

}  // namespace trocar::step
