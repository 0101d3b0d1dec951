#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::io {

/// Throws Failure (74) when the file cannot be written: to be known before the run. Rank 0 only.
void require_size_field(const std::string& file);

/// Writes edge lengths [m] at the nodes as a Gmsh view of the mesh's tets in its own unit, for
/// `gmsh -bgm`. Throws Failure (74). Rank 0 only.
void write_size_field(const std::string& file, const mesh::Mesh& mesh, const core::VecX& sizes);

}  // namespace trocar::io
