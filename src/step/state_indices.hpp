#pragma once

#include "fem/space.hpp"
#include "step/state.hpp"

namespace trocar::step {

/// Throws Failure (65) when an index into the mesh or a list is out of range, or when lists that
/// belong together differ in length. Users of a state do not check this.
void refuse_indices_of_nothing(const State& state, const fem::Space& space);

}  // namespace trocar::step
