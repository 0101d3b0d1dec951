#pragma once

#include <array>

#include "mesh/mesh.hpp"

namespace trocar::fem {

/// Constant gradients of the four linear shape functions of a tet, and its volume.
struct TetShape
{
  Eigen::Matrix<double, 3, 4> gradient;  ///< column a = grad N_a [1/m]
  double volume;                         ///< [m³]
};

inline TetShape tet_shape(const std::array<core::Vec3, 4>& corner)
{
  core::Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = corner[static_cast<std::size_t>(a) + 1] - corner[0];
  TetShape shape;
  shape.volume = D.determinant() / 6.0;
  shape.gradient.rightCols<3>() = D.inverse().transpose();
  shape.gradient.col(0) = -shape.gradient.rightCols<3>().rowwise().sum();
  return shape;
}

}  // namespace trocar::fem
