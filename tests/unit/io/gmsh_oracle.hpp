#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::test {

/// What Gmsh's own library makes of a mesh file, in our order: nodes and tets of physical volumes
/// by tag, triangles by group and entity. Points and curves are left out. For one rank.
mesh::Mesh read_with_gmsh(const std::string& file, double scale);

}  // namespace trocar::test
