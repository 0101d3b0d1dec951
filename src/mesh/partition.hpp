#pragma once

#include <vector>

#include "base/comm.hpp"
#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Owner rank of every node, by METIS's k-way partition of the dual graph (tets that share a face).
/// METIS also assigns the nodes to the parts. Parts may be empty on tiny meshes. Collective.
std::vector<int> partition_nodes(const Mesh& mesh, const base::Comm& comm);

}  // namespace trocar::mesh
