#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The nodes of the face in ascending order: a key that does not depend on the orientation.
Face sorted(Face face);

/// Tets around each node in compressed rows: node i has tet[start[i]] … tet[start[i+1]-1],
/// ascending.
struct NodeToTets
{
  std::vector<int> start, tet;
};
NodeToTets node_to_tets(const Mesh& mesh);

/// A face as seen from one of its tets.
struct TetFace
{
  Face nodes;  ///< ascending
  int tet;
  int local;    ///< local number of the corner opposite to the face
  bool turned;  ///< `nodes` run clockwise when seen from outside the tet
};

/// Calls `visit` once for every face, with one TetFace for each tet of the face. Faces come in
/// ascending order of their nodes. The only memory needed is that of the tets around each node.
void visit_faces(const Mesh& mesh, const std::function<void(std::span<const TetFace>)>& visit);

/// A face on the boundary, oriented so that its normal points out of its tet.
struct BoundaryFace
{
  Face nodes;
  int tet;
};

/// Faces that belong to exactly one tet, in the order of their tets.
std::vector<BoundaryFace> boundary_faces(const Mesh& mesh);

/// Number of the connected component of every node. Nodes of the same tet are in the same
/// component. `count` gets the number of components.
std::vector<int> connected_components(const Mesh& mesh, int& count);

}  // namespace trocar::mesh
