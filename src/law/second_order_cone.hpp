#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math.hpp"

// The second-order cone u_0 >= |(u_1, u_2)| for interior point methods: its Jordan algebra and the
// scaling of Nesterov and Todd (1997).
namespace trocar::law::cone {

using core::Mat3;
using core::Vec3;

/// √(u_0² - |(u_1, u_2)|²), at least 1e-150, so that a point on the border causes no division by 0.
inline double root(const Vec3& u)
{
  const double across = u.tail<2>().norm();
  return std::sqrt(std::max((u[0] - across) * (u[0] + across), 1e-300));
}

/// Jordan product a ∘ b = (a·b, a_0 b_t + b_0 a_t).
inline Vec3 product(const Vec3& a, const Vec3& b)
{
  Vec3 c;
  c << a.dot(b), a[0] * b.tail<2>() + b[0] * a.tail<2>();
  return c;
}

/// Solves a ∘ x = b for x; a lies inside the cone.
inline Vec3 divided(const Vec3& b, const Vec3& a)
{
  const double determinant = root(a) * root(a);
  Vec3 x;
  x[0] = (a[0] * b[0] - a.tail<2>().dot(b.tail<2>())) / determinant;
  x.tail<2>() = (b.tail<2>() - x[0] * a.tail<2>()) / a[0];
  return x;
}

/// Largest t for which u + t d lies in the cone; infinite if every t > 0 does.
inline double step_to_border(const Vec3& u, const Vec3& d)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double a = d[0] * d[0] - d.tail<2>().squaredNorm();
  const double b = u[0] * d[0] - u.tail<2>().dot(d.tail<2>());
  const double c = root(u) * root(u);
  double step = d[0] < 0.0 ? -u[0] / d[0] : infinity;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return step;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  for (double t : {a != 0.0 ? q / a : infinity, q != 0.0 ? c / q : infinity})
    if (t > 0.0) step = std::min(step, t);
  return step;
}

/// Scaling of two points u and z inside the cone: the symmetric W with W z = W⁻¹ u = λ.
struct Scaling
{
  Scaling() = default;
  Scaling(const Vec3& u, const Vec3& z)
  {
    const Vec3 unit_u = u / root(u), unit_z = z / root(z);
    const double half = std::sqrt(0.5 * (1.0 + unit_u.dot(unit_z)));
    Vec3 mirrored = unit_z;
    mirrored.tail<2>() *= -1.0;
    const Vec3 q = (unit_u + mirrored) / (2.0 * half);
    const double size = std::sqrt(root(u) / root(z));
    Mat3 B;
    B.row(0) = q.transpose();
    B.col(0) = q;
    B.bottomRightCorner<2, 2>() =
        Eigen::Matrix2d::Identity() + q.tail<2>() * q.tail<2>().transpose() / (1.0 + q[0]);
    W = size * B;
    B.block<1, 2>(0, 1) *= -1.0;
    B.block<2, 1>(1, 0) *= -1.0;
    inverse = B / size;
    lambda = W * z;
  }
  Mat3 W = Mat3::Identity(), inverse = Mat3::Identity();
  Vec3 lambda = Vec3::Zero();
};

}  // namespace trocar::law::cone
