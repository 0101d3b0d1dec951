#pragma once

#include <array>
#include <cmath>

#include "mesh/quadratic.hpp"

namespace trocar::fem {

/// Shape gradients of a tet with N nodes (4 or 10) at an integration point, and the volume that the
/// point stands for.
template <int N>
struct PointShape
{
  Eigen::Matrix<double, 3, N> gradient;  ///< column a = grad N_a [1/m]
  double volume;                         ///< weight times Jacobian determinant [m³]
};

/// For linear tets: gradients are constant, so one integration point is enough.
using TetShape = PointShape<4>;

/// Number of integration points of the stiffness, which are exact for straight tets.
template <int N>
inline constexpr int points_per_tet = N == 4 ? 1 : 4;

/// Barycentric coordinates of the integration points, which are also the values of the four linear
/// shape functions there; one point per column.
template <int N>
Eigen::Matrix<double, 4, points_per_tet<N>> corner_weights()
{
  if constexpr (N == 4) {
    return Eigen::Vector4d::Constant(0.25);
  } else {
    // Quadrature of degree 2 (Hammer and Stroud 1956).
    const double own = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0;
    const double other = (5.0 - std::sqrt(5.0)) / 20.0;
    return Eigen::Matrix4d::Constant(other) + (own - other) * Eigen::Matrix4d::Identity();
  }
}

/// (∫ N_a N_b dV) / V of a straight tet, exact.
template <int N>
Eigen::Matrix<double, N, N> straight_mass()
{
  Eigen::Matrix<double, N, N> mass;
  if constexpr (N == 4) {
    mass.setConstant(1.0 / 20.0);
    mass.diagonal().setConstant(1.0 / 10.0);
  } else {
    // Entries times 420. Two corners: 6 if equal, else 1. A corner and a middle node: -4 if the
    // corner is an end of the edge, else -6. Two middle nodes: 32 if equal, 16 if their edges have
    // an end in common, else 8.
    const auto ends = [](int a) -> std::array<int, 2> {
      if (a < 4) return {a, a};
      const auto [i, j] = mesh::tet_edges[static_cast<std::size_t>(a - 4)];
      return {static_cast<int>(i), static_cast<int>(j)};
    };
    for (int a = 0; a < N; ++a)
      for (int b = 0; b < N; ++b) {
        const auto [i, j] = ends(a);
        const auto [k, l] = ends(b);
        const bool touch = i == k || i == l || j == k || j == l;
        if (a < 4 && b < 4)
          mass(a, b) = a == b ? 6.0 : 1.0;
        else if (a < 4 || b < 4)
          mass(a, b) = touch ? -4.0 : -6.0;
        else
          mass(a, b) = a == b ? 32.0 : touch ? 16.0 : 8.0;
      }
    mass /= 420.0;
  }
  return mass;
}

TetShape tet_shape(const std::array<core::Vec3, 4>& corner);

/// Shape gradients and volume of an integration point at the barycentric coordinates `at` of a
/// quadratic tet with the node positions x [m]. The weights of a tet's points add up to 1.
PointShape<10> quadratic_point(const Eigen::Matrix<double, 3, 10>& x, const Eigen::Vector4d& at,
                               double weight);

/// Shape gradients and volumes of all integration points of a tet.
template <int N>
std::array<PointShape<N>, points_per_tet<N>> point_shapes(const mesh::Mesh& mesh, int tet)
{
  if constexpr (N == 4) {
    return {tet_shape(mesh::corners(mesh, tet))};
  } else {
    const Eigen::Matrix<double, 3, 10> x = mesh::positions(mesh, tet);
    const Eigen::Matrix4d at = corner_weights<10>();
    std::array<PointShape<10>, 4> shapes;
    for (int q = 0; q < 4; ++q)
      shapes[static_cast<std::size_t>(q)] = quadratic_point(x, at.col(q), 0.25);
    return shapes;
  }
}

}  // namespace trocar::fem
