#pragma once

#include "core/archive.hpp"
#include "step/state.hpp"

namespace trocar::step {

/// Complete on rank 0; of fields nothing elsewhere. Collective.
core::Archive archived(const State& state, const fem::Space& space);

/// The state again, on any number of ranks; `archive` is rank 0's. Failure (65) where it is not
/// that of such a state. Collective.
State restored(core::Archive archive, const fem::Space& space);

}  // namespace trocar::step
