#pragma once

#include "core/archive.hpp"
#include "step/state.hpp"

namespace trocar::step {

/// The state as an archive. It is complete on rank 0; on other ranks the fields by tet are empty.
/// Collective.
core::Archive archived(const State& state, const fem::Space& space);

/// The state that `archive` describes, on any number of ranks. Only the archive of rank 0 counts.
/// Throws Failure (65) when it does not describe a state on this mesh. Collective.
State restored(core::Archive archive, const fem::Space& space);

}  // namespace trocar::step
