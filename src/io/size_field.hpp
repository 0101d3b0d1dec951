#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::io {

/// Writes edge lengths [m] at the nodes as a Gmsh view of the mesh's tets, for `gmsh -bgm`. Throws
/// Failure (74). Rank 0 only.
void write_size_field(const std::string& file, const mesh::Mesh& mesh, const core::VecX& sizes);

}  // namespace trocar::io
