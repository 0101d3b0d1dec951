#include "core/math.hpp"

#include <cmath>

namespace trocar::core {

Mat3 rotation_exp(const Vec3& w)
{
  const double angle = w.norm();
  const Mat3 K = skew(w);
  if (angle < 1e-8) return Mat3::Identity() + K + 0.5 * K * K;
  return Mat3::Identity() + std::sin(angle) / angle * K +
         (1.0 - std::cos(angle)) / (angle * angle) * K * K;
}

Vec3 rotation_log(const Mat3& R)
{
  // The quaternion is well-conditioned at 0 and π; the formula with the trace of R is not.
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

Mat3 rotation_between(const Vec3& a, const Vec3& b)
{
  const double cosine = a.dot(b);
  if (cosine < -1.0 + 1e-12) {
    const Vec3 axis = frame_along(a).col(1);
    return 2.0 * axis * axis.transpose() - Mat3::Identity();
  }
  const double s = std::sqrt(2.0 * (1.0 + cosine));
  const Vec3 half = a.cross(b) / s;  // the axis times the sine of half the angle
  return Eigen::Quaterniond(0.5 * s, half.x(), half.y(), half.z()).toRotationMatrix();
}

Mat3 frame_along(const Vec3& t)
{
  Eigen::Index smallest = 0;
  t.cwiseAbs().minCoeff(&smallest);
  const Vec3 n = t.cross(Vec3::Unit(smallest)).normalized();
  Mat3 frame;
  frame.col(0) = t;
  frame.col(1) = n;
  frame.col(2) = t.cross(n);
  return frame;
}

Mat3 polar_rotation(const Mat3& F)
{
  Mat3 R = F;
  for (int k = 0; k < 50; ++k) {
    const Mat3 inverse_transpose = R.inverse().transpose();
    const double gamma = std::sqrt(inverse_transpose.norm() / R.norm());
    const Mat3 next = 0.5 * (gamma * R + inverse_transpose / gamma);
    const double change = (next - R).squaredNorm();
    R = next;
    if (change < 1e-28) break;
  }
  return R;
}

}  // namespace trocar::core
