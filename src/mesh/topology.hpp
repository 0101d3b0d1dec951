#pragma once

#include <functional>
#include <span>
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

/// A face as one tet has it.
struct TetFace
{
  Face nodes;  ///< ascending
  int tet;
  int local;    ///< the corner opposite to it
  bool turned;  ///< seen from outside of the tet, its nodes run clockwise
};

/// Shows every face with all tets that have it, faces in the order of their nodes. Memory for the
/// tets of the nodes alone.
void visit_faces(const Mesh& mesh, const std::function<void(std::span<const TetFace>)>& visit);

/// A face on the boundary, oriented so that its normal points out of its tet.
struct BoundaryFace
{
  Face nodes;
  int tet;
};

/// Faces that belong to exactly one tet, in tet order.
std::vector<BoundaryFace> boundary_faces(const Mesh& mesh);

/// Component number of every node: nodes joined by tets share one. `count` gets how many.
std::vector<int> connected_components(const Mesh& mesh, int& count);

}  // namespace trocar::mesh
