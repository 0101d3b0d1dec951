#pragma once

#include <string>
#include <vector>

#include "driver/option_source.hpp"
#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// Version, commit and build of this program and the version of PETSc, in one line.
std::string build_description();

/// Data on the origin of the results, for /provenance. `solver`: description of the tissue's
/// solver.
io::Provenance provenance(const step::Model& model, const Invocation& invocation,
                          const std::vector<core::ResolvedOption>& options,
                          const std::string& solver);

/// One line on a restart: date, step and time of the checkpoint, program, command line.
std::string restart_note(const io::Checkpoint& from, const Invocation& invocation);

}  // namespace trocar::driver
