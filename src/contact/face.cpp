#include "contact/face.hpp"

#include <cmath>

namespace trocar::contact {

FaceShape face_shape(int count, const Param& at)
{
  const double b = at[0], c = at[1], a = 1.0 - b - c;
  FaceShape shape{Eigen::Matrix<double, 6, 1>::Zero(), Eigen::Matrix<double, 6, 2>::Zero()};
  if (count == 3) {
    shape.value.head<3>() << a, b, c;
    shape.slope.topRows<3>() << -1, -1, 1, 0, 0, 1;
    return shape;
  }
  shape.value << a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a;
  shape.slope << 1 - 4 * a, 1 - 4 * a, 4 * b - 1, 0, 0, 4 * c - 1,  //
      4 * (a - b), -4 * b, 4 * c, 4 * b, -4 * c, 4 * (a - c);
  return shape;
}

FacePoint face_point(const FacePlaces& face, const Param& at)
{
  const FaceShape shape = face_shape(face.count, at);
  FacePoint point{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < face.count; ++k) {
    const Vec3& x = face.x[static_cast<std::size_t>(k)];
    point.x += shape.value[k] * x;
    point.along += shape.slope(k, 0) * x;
    point.across += shape.slope(k, 1) * x;
  }
  return point;
}

const std::array<TrianglePoint, 7>& triangle_points()
{
  static const std::array<TrianglePoint, 7> points = [] {
    std::array<TrianglePoint, 7> found;
    found[0] = {Eigen::Vector3d::Constant(1.0 / 3.0), 9.0 / 40.0};
    const double root = std::sqrt(15.0);
    std::size_t next = 1;
    for (double sign : {-1.0, 1.0}) {
      const double a = (6.0 + sign * root) / 21.0, weight = (155.0 + sign * root) / 1200.0;
      for (int k = 0; k < 3; ++k) {
        Eigen::Vector3d at = Eigen::Vector3d::Constant(a);
        at[k] = 1.0 - 2.0 * a;
        found[next++] = {at, weight};
      }
    }
    return found;
  }();
  return points;
}

std::array<std::array<std::size_t, 3>, 4> flat_triangles()
{
  return {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
}

Param node_param(std::size_t node)
{
  static const std::array<Param, 6> at{Param(0, 0),   Param(1, 0),     Param(0, 1),
                                       Param(0.5, 0), Param(0.5, 0.5), Param(0, 0.5)};
  return at[node];
}

Projection project(const FacePlaces& face, const Vec3& x, const Vec3& n, const Param& at)
{
  constexpr int most = 20;
  constexpr double settled = 1e-13;
  Projection result{at, 0.0, false};
  for (int k = 0; k < most; ++k) {
    const FacePoint point = face_point(face, result.at);
    core::Mat3 slopes;
    slopes << point.along, point.across, -n;
    const Vec3 step = slopes.inverse() * (x + result.t * n - point.x);
    result.at += step.head<2>();
    result.t += step[2];
    if (!step.allFinite()) return result;
    if (step.head<2>().cwiseAbs().maxCoeff() < settled || (face.count == 3 && k > 0)) {
      result.found = true;
      return result;
    }
  }
  return result;
}

}  // namespace trocar::contact
