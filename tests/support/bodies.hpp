#pragma once

#include "mesh/mesh.hpp"

namespace trocar::test {

/// Two meshes in one. Volumes and surfaces of the first are named "a_…", of the second "b_…".
mesh::Mesh joined(const mesh::Mesh& a, const mesh::Mesh& b);

}  // namespace trocar::test
