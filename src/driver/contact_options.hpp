#pragma once

#include "driver/scenario.hpp"

namespace trocar::driver {

/// Settings of contact. Throws Failure (64) for bad or idle options, (65) for unknown surfaces.
contact::Settings read_contact(core::Options& options, const mesh::Mesh& mesh,
                               const base::Comm& comm);

}  // namespace trocar::driver
