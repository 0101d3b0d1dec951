#pragma once

#include "base/comm.hpp"
#include "core/options.hpp"
#include "tissue/boundary.hpp"

namespace trocar::driver {

/// Supports, prescribed displacements, tractions and gravity. Throws Failure (64, 65). Collective.
tissue::BoundaryConditions read_boundary(core::Options& options, const mesh::Mesh& mesh,
                                         const base::Comm& comm);

}  // namespace trocar::driver
