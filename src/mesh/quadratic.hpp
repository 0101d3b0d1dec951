#pragma once

#include <optional>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The nodes of a tet: 4 corners, and on a quadratic mesh the middles of edges 01, 12, 20, 03, 13,
/// 23 (VTK's order).
struct TetNodes
{
  std::array<int, 10> node;
  int count;

  const int* begin() const { return node.data(); }
  const int* end() const { return node.data() + count; }
};
TetNodes nodes_of(const Mesh& mesh, int tet);

/// The nodes of a face: 3 corners, and on a quadratic mesh the middles of edges 01, 12, 20.
std::vector<int> nodes_of(const Mesh& mesh, const Face& face);

/// Makes a mesh of linear tets quadratic, by a new node at the midpoint of every edge; edges stay
/// straight. The new tags follow the largest tag, in the order of the edges' corners. Leaves a
/// quadratic mesh as it is.
void make_quadratic(Mesh& mesh);

/// Both corners of the edge that has `node` as its middle node; nothing for a corner. Searches all
/// tets.
std::optional<std::array<int, 2>> ends_of_middle(const Mesh& mesh, int node);

/// Makes a quadratic mesh linear: drops the middle nodes, so curved edges become straight.
void make_linear(Mesh& mesh);

/// Shape functions of the quadratic tet at barycentric coordinates.
Eigen::Matrix<double, 10, 1> quadratic_shape(const Eigen::Vector4d& at);
/// Derivatives of these shape functions by the four barycentric coordinates, taken as independent;
/// row a is of node a.
Eigen::Matrix<double, 10, 4> quadratic_derivatives(const Eigen::Vector4d& at);

/// Values of the shape functions at barycentric coordinates, by node of the tet.
using NodeWeights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1>;
NodeWeights node_weights(const Mesh& mesh, const Eigen::Vector4d& at);

/// Positions of the nodes of a tet, one per column.
using TetPositions = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 10>;
TetPositions positions(const Mesh& mesh, int tet);

/// Barycentric coordinates (sum 1) that the tet with these node positions maps to p. For a curved
/// tet Newton's method finds them. It starts from the coordinates in the straight tet of the
/// corners; these are the answer where it diverges.
Eigen::Vector4d local_coordinates(const TetPositions& x, const Vec3& p);

/// True when every middle node lies at the midpoint of its edge, to 1e-12 of the edge's length.
bool is_straight(const TetPositions& x);

/// Signed volume [m³] of the tet with these node positions: the exact integral of the Jacobian
/// determinant, a cubic polynomial.
double curved_volume(const TetPositions& x);

/// Smallest ratio, over corners and integration points, of the Jacobian determinant of the map to
/// that of the straight tet. It is 1 for a straight tet and not positive for a folded one.
double smallest_jacobian(const TetPositions& x);

}  // namespace trocar::mesh
