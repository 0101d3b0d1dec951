#pragma once

#include <array>

#include "core/math.hpp"

// Geometry of one face: a triangle of three nodes, or a curved one of six. Pure functions.
namespace trocar::contact {

using core::Vec3;

/// Nodes of a face: the corners, then (six nodes) the middles of the edges 01, 12, 20.
template <class T>
using ByNode = std::array<T, 6>;

/// Parameters of a place on a face: the corners are (0, 0), (1, 0), (0, 1).
using Param = Eigen::Vector2d;

/// Values of the shape functions, and their derivatives by the parameters. Entries beyond `count`
/// (3 or 6) are zero.
struct FaceShape
{
  Eigen::Matrix<double, 6, 1> value;
  Eigen::Matrix<double, 6, 2> slope;
};
FaceShape face_shape(int count, const Param& at);

/// Node positions [m].
struct FacePlaces
{
  int count = 3;
  ByNode<Vec3> x{};
};

/// A place on a face and its two tangents ∂x/∂ξ, ∂x/∂η [m].
struct FacePoint
{
  Vec3 x, along, across;
};
FacePoint face_point(const FacePlaces& face, const Param& at);

/// Integration of degree 5 on a triangle: barycentric coordinates and weights of 7 points, sum 1
/// (Radon 1948).
struct TrianglePoint
{
  Eigen::Vector3d at;
  double weight;
};
const std::array<TrianglePoint, 7>& triangle_points();

/// The flat triangles that stand for a face in clipping: one, or four of six nodes. Local nodes.
std::array<std::array<std::size_t, 3>, 4> flat_triangles();
inline int flat_count(int count)
{
  return count == 3 ? 1 : 4;
}
/// Parameters of a local node.
Param node_param(std::size_t node);

/// Where the line x + t n meets a face: the parameters there and t [m]. Newton's method on the true
/// face; it starts from `at` and extrapolates the face beyond its edges.
struct Projection
{
  Param at;
  double t;
  bool found;
};
Projection project(const FacePlaces& face, const Vec3& x, const Vec3& n, const Param& at);

}  // namespace trocar::contact
