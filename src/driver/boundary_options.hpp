#pragma once

#include "base/comm.hpp"
#include "core/options.hpp"
#include "tissue/boundary.hpp"

namespace trocar::driver {

/// Reads a factor over time from a CSV file (columns time, factor). Returns nothing when `file` is
/// empty. Failure (65). Collective.
std::optional<core::Csv> read_curve(const std::string& file, const base::Comm& comm);

/// Reads supports, prescribed displacements, tractions and gravity. Throws Failure (64, 65).
/// Collective.
tissue::BoundaryConditions read_boundary(core::Options& options, const mesh::Mesh& mesh,
                                         const base::Comm& comm);

}  // namespace trocar::driver
