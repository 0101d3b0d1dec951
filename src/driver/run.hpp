#pragma once

#include "base/comm.hpp"
#include "core/failure.hpp"

namespace trocar::driver {

/// Runs what the arguments say: 0, or 75 when it ended at a checkpoint. Failure when it could not.
/// Collective.
core::ExitCode run_scene(int argc, char** argv, const base::Comm& comm);

}  // namespace trocar::driver
