#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The face's nodes ascending: its name, whichever way it looks.
Face sorted(Face face);

/// Tets around each node, compressed: those of node i are tet[start[i]] … tet[start[i+1]-1],
/// ascending.
struct NodeToTets
{
  std::vector<int> start, tet;
};
NodeToTets node_to_tets(const Mesh& mesh);

/// A face on the boundary, oriented so that its normal points out of its tet.
struct BoundaryFace
{
  Face nodes;
  int tet;
};

/// Faces that belong to exactly one tet, in tet order. Throws Failure (65) when a face belongs to
/// three or more.
std::vector<BoundaryFace> boundary_faces(const Mesh& mesh);

/// Component number of every node: nodes joined by tets share one. `count` gets how many.
std::vector<int> connected_components(const Mesh& mesh, int& count);

}  // namespace trocar::mesh
