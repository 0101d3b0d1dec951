#pragma once

#include "step/scheme.hpp"

namespace trocar::step {

/// Where a step starts to iterate from: needles with their bases at its end, paths grown and points
/// born as their tips went through tissue where the old state has it, what they have opened of
/// cavities, and amounts of fluid. Decided before the solve and frozen during it. Refused where a
/// shaft enters the tissue beside its channel. Collective.
core::Outcome<State> predict(const Model& model, const State& old, const Scheme& scheme);

}  // namespace trocar::step
