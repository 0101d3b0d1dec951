#pragma once

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The meshes of several files as one: nodes and tets by file, then by tag. Throws Failure (65)
/// where two files have a group of one name, or only some have middle nodes.
Mesh joined(const std::vector<Mesh>& parts);

}  // namespace trocar::mesh
