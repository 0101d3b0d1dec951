#pragma once

#include <array>
#include <cmath>

#include "core/math.hpp"

namespace trocar::core {

/// Rotations of the polar decompositions F = R U of `width` matrices side by side, one per lane.
/// Newton iteration X <- (γX + X⁻ᵀ/γ)/2 (Higham 1986); γ differs from 1 only while X is far from
/// its limit. Valid for det F > 0 only.
class PolarBatch
{
 public:
  static constexpr int width = 8;
  using Lanes = Eigen::Array<double, width, 1>;
  using Matrix = std::array<Lanes, 9>;  ///< entries, column-major

  Matrix& matrix() { return X_; }
  void set(int lane, const Mat3& F)
  {
    for (std::size_t k = 0; k < 9; ++k) X_[k][lane] = F(static_cast<Eigen::Index>(k));
  }
  Lanes determinant() const
  {
    const Matrix C = cofactors();
    return X_[0] * C[0] + X_[1] * C[1] + X_[2] * C[2];
  }
  Mat3 get(int lane) const
  {
    Mat3 R;
    for (std::size_t k = 0; k < 9; ++k) R(static_cast<Eigen::Index>(k)) = X_[k][lane];
    return R;
  }

  void rotate()
  {
    constexpr int most = 50;
    // Limits of the squared change. The error after an iteration is half its squared change.
    constexpr double far = 1e-2, enough = 1e-15;
    Lanes change = Lanes::Ones();
    for (int k = 0; k < most && (change > enough).any(); ++k) change = iterate(change, far, enough);
  }

 private:
  /// One iteration. `before`: squared change of the last iteration; lanes where it is at most
  /// `enough` stay as they are. Returns the new squared change, 0 in those lanes. Lanes do not
  /// influence each other: which matrices share a batch differs between ranks, but their rotations
  /// must not.
  Lanes iterate(const Lanes& before, double far, double enough)
  {
    const Matrix C = cofactors();
    const Lanes inverse_det = (X_[0] * C[0] + X_[1] * C[1] + X_[2] * C[2]).inverse();
    Lanes half_gamma = Lanes::Constant(0.5);
    Lanes half_inverse = 0.5 * inverse_det;
    if ((before > far).any()) {
      Lanes of_X = Lanes::Zero(), of_C = Lanes::Zero();
      for (std::size_t i = 0; i < 9; ++i) {
        of_X += X_[i].square();
        of_C += C[i].square();
      }
      const Lanes gamma =
          (before > far).select(((of_C / of_X).sqrt() * inverse_det.abs()).sqrt(), 1.0);
      half_gamma *= gamma;
      half_inverse /= gamma;
    }
    Lanes change = Lanes::Zero();
    for (std::size_t i = 0; i < 9; ++i) {
      const Lanes next = half_gamma * X_[i] + half_inverse * C[i];
      change += (next - X_[i]).square();
      X_[i] = (before > enough).select(next, X_[i]);
    }
    return (before > enough).select(change, 0.0);
  }

  /// Cofactor matrix det(X) X⁻ᵀ.
  Matrix cofactors() const
  {
    const Matrix& X = X_;
    return {X[4] * X[8] - X[5] * X[7], X[5] * X[6] - X[3] * X[8], X[3] * X[7] - X[4] * X[6],
            X[2] * X[7] - X[1] * X[8], X[0] * X[8] - X[2] * X[6], X[1] * X[6] - X[0] * X[7],
            X[1] * X[5] - X[2] * X[4], X[2] * X[3] - X[0] * X[5], X[0] * X[4] - X[1] * X[3]};
  }

  Matrix X_{};
};

}  // namespace trocar::core
