#pragma once

#include "base/comm.hpp"
#include "core/options.hpp"
#include "tissue/boundary.hpp"

namespace trocar::driver {

/// A factor over time (columns time, factor); nothing when no file is named. Failure (65).
/// Collective.
std::optional<core::Csv> read_curve(const std::string& file, const base::Comm& comm);

/// Supports, prescribed displacements, tractions and gravity. Throws Failure (64, 65). Collective.
tissue::BoundaryConditions read_boundary(core::Options& options, const mesh::Mesh& mesh,
                                         const base::Comm& comm);

}  // namespace trocar::driver
