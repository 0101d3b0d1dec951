#pragma once

#include <Eigen/Dense>

namespace trocar::core {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;

/// Skew-symmetric matrix [w]× with skew(w) a = w × a.
inline Mat3 skew(const Vec3& w)
{
  Mat3 m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

/// Rotation matrix of the rotation vector w [rad] (Rodrigues).
Mat3 rotation_exp(const Vec3& w);

/// Rotation vector [rad] of the rotation matrix R, |w| <= π; the inverse of `rotation_exp`.
Vec3 rotation_log(const Mat3& R);

/// Smallest rotation that takes the unit vector a to the unit vector b. If they are opposite, half
/// a turn about some normal of a.
Mat3 rotation_between(const Vec3& a, const Vec3& b);

/// Orthonormal frame whose first column is the unit vector t.
Mat3 frame_along(const Vec3& t);

/// Rotation R of the polar decomposition F = R U, by the scaled Newton iteration (Higham 1986),
/// exact to round-off. The caller checks that det F > 0.
Mat3 polar_rotation(const Mat3& F);

}  // namespace trocar::core
