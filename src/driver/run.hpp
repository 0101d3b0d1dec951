#pragma once

#include "base/comm.hpp"
#include "core/failure.hpp"

namespace trocar::driver {

/// Runs the scene that the arguments describe. Returns 0, or 75 when the run ended early with a
/// checkpoint. Throws Failure when it cannot go on. Collective.
core::ExitCode run_scene(int argc, char** argv, const base::Comm& comm);

}  // namespace trocar::driver
