#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

/// Cholesky factorisation W ≈ L Lᵀ with diagonal pivoting, of a symmetric positive semidefinite
/// matrix. One sweep gives the numerical rank, a well-conditioned set of as many rows, and their
/// factor. The sweep ends at a pivot below `cut * scale`.
/// `scale`: largest diagonal entry of the matrix from which this one was computed (0: of this one).
/// A Schur complement that should vanish contains round-off of that matrix, so its own diagonal is
/// no scale.
class PivotedCholesky
{
 public:
  explicit PivotedCholesky(core::MatX matrix, double scale = 0.0, double cut = 1e-10);

  int rank() const { return rank_; }
  /// Largest over smallest kept pivot: a lower bound of the kept rows' condition number.
  double condition() const;
  /// The kept rows, by falling pivot.
  std::vector<int> kept() const { return {order_.begin(), order_.begin() + rank_}; }
  /// `half_solve`: L⁻¹ b. `solve`: L⁻ᵀ L⁻¹ b. The rows of b are the kept rows in the order of
  /// `kept`.
  core::MatX half_solve(core::MatX b) const;
  core::VecX solve(core::VecX b) const;
  /// Orthogonal projection of x (all rows) onto the range of L, which is the range of the matrix.
  core::VecX onto_range(const core::VecX& x) const;

 private:
  core::MatX factor_;       ///< L in its first rank_ columns; its rows are in the order of order_
  std::vector<int> order_;  ///< kept rows by falling pivot, then the other rows
  int rank_ = 0;
};

}  // namespace trocar::law
