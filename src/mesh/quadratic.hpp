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

/// Makes a mesh of linear tets quadratic: a node on the middle of every edge, tagged on from the
/// largest tag in the order of the edges' corners. Straight; nothing to do when it is quadratic.
void make_quadratic(Mesh& mesh);

/// The corners between which a node is the middle; nothing for a corner. Looks through all tets.
std::optional<std::array<int, 2>> ends_of_middle(const Mesh& mesh, int node);

/// Leaves the corners of a quadratic mesh; curved edges become straight.
void make_linear(Mesh& mesh);

/// Shape functions of the quadratic tet at barycentric coordinates.
Eigen::Matrix<double, 10, 1> quadratic_shape(const Eigen::Vector4d& at);
/// Their derivatives by the four barycentric coordinates, taken as independent (row a: of node a).
Eigen::Matrix<double, 10, 4> quadratic_derivatives(const Eigen::Vector4d& at);

/// Values of the shape functions, by node of the tet.
using NodeWeights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1>;
NodeWeights node_weights(const Mesh& mesh, const Eigen::Vector4d& at);

/// Positions of the nodes of a tet, one per column.
using TetPositions = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 10>;
TetPositions positions(const Mesh& mesh, int tet);

/// Coordinates (sum 1) in the tet with these node positions at which its map gives p; by Newton
/// when it is curved, from and, where that leads nowhere, instead by the corners alone.
Eigen::Vector4d local_coordinates(const TetPositions& x, const Vec3& p);

/// True when all middles are in the middle.
bool is_straight(const TetPositions& x);

/// Volume [m³] of the tet with these node positions: the integral of the Jacobian determinant, a
/// cubic, exactly; negative where the corners are turned over.
double curved_volume(const TetPositions& x);

/// Smallest Jacobian determinant of the map over that of the straight tet, at corners and
/// integration points: 1 for straight tets, not positive for folded ones.
double smallest_jacobian(const TetPositions& x);

}  // namespace trocar::mesh
