#include "fem/shape.hpp"

namespace trocar::fem {

TetShape tet_shape(const std::array<core::Vec3, 4>& corner)
{
  core::Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = corner[static_cast<std::size_t>(a) + 1] - corner[0];
  TetShape shape;
  shape.volume = D.determinant() / 6.0;
  shape.gradient.rightCols<3>() = D.inverse().transpose();
  shape.gradient.col(0) = -shape.gradient.rightCols<3>().rowwise().sum();
  return shape;
}

PointShape<10> quadratic_point(const Eigen::Matrix<double, 3, 10>& x, const Eigen::Vector4d& at,
                               double weight)
{
  const Eigen::Matrix<double, 10, 4> by = mesh::quadratic_derivatives(at);
  const Eigen::Matrix<double, 10, 3> free = by.rightCols<3>().colwise() - by.col(0);
  const core::Mat3 J = x * free;
  return {J.inverse().transpose() * free.transpose(), weight * J.determinant() / 6.0};
}

}  // namespace trocar::fem
