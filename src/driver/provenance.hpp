#pragma once

#include <string>
#include <vector>

#include "driver/option_source.hpp"
#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// Versions, commit and build of this program, one line.
std::string build_description();

/// What a result file says about where it comes from. `solver` describes the tissue's solver.
io::Provenance provenance(const step::Model& model, const Invocation& invocation,
                          const std::vector<core::ResolvedOption>& options,
                          const std::string& solver);

/// Who went on from where, one line.
std::string restart_note(const io::Checkpoint& from, const Invocation& invocation);

}  // namespace trocar::driver
