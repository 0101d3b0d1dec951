#pragma once

#include "io/msh_file.hpp"
#include "mesh/mesh.hpp"

namespace trocar::io {

/// Makes the mesh of a file: the tets in physical volumes, their nodes, and the physical groups,
/// each in the order of their tags. Coordinates are multiplied by `scale` [m]. Groups of one
/// dimension and one name are merged, with a remark. Nodes that are listed twice in a group of
/// points or curves count once. Failure (65) without tets, or when a group holds elements of
/// another order than the tets or other shapes than simplices. Call on one rank only.
mesh::Mesh mesh_of(const MshFile& file, double scale);

}  // namespace trocar::io
