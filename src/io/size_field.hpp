#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::io {

/// Throws Failure (74) when the file cannot be written. Call it before the run. Rank 0 only.
void require_size_field(const std::string& file);

/// Writes the edge lengths `sizes` [m] at the nodes as a Gmsh view, which `gmsh -bgm` takes as a
/// background field. The file has the length unit of the mesh file. Throws Failure (74). Rank 0
/// only.
void write_size_field(const std::string& file, const mesh::Mesh& mesh, const core::VecX& sizes);

}  // namespace trocar::io
