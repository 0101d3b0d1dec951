#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::io {

/// Reads a Gmsh file (2.2 or 4.1, ascii or binary) on rank 0 and gives it to every rank.
/// Physical volumes, surfaces, curves and points by name (a group without a name is "volume_TAG"
/// etc.); only tets in a physical volume count; coordinates are multiplied by `scale`. Throws
/// Failure (65) on every rank, with file and tag, for a mesh that cannot be used. Collective.
mesh::Mesh read_gmsh(const std::string& file, double scale, const base::Comm& comm);

}  // namespace trocar::io
