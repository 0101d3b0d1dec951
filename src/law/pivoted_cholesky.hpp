#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

/// W ≈ L Lᵀ of a symmetric positive semidefinite matrix by Cholesky with diagonal pivoting: its
/// numerical rank, a well-conditioned set of that many rows, and their factor, all in one sweep.
/// A pivot below `cut * scale` ends it. `scale` is the largest diagonal entry of what the matrix
/// was made from: a Schur complement that should vanish is round-off of that, not of itself;
/// 0 takes the matrix's own.
class PivotedCholesky
{
 public:
  explicit PivotedCholesky(core::MatX matrix, double scale = 0.0, double cut = 1e-10);

  int rank() const { return rank_; }
  /// Largest over smallest kept pivot: the condition number of the kept rows is at least this.
  double condition() const;
  /// The kept rows, by falling pivot.
  std::vector<int> kept() const { return {order_.begin(), order_.begin() + rank_}; }
  /// L⁻¹ b and L⁻ᵀ L⁻¹ b, both on the kept rows in their order.
  core::MatX half_solve(core::MatX b) const;
  core::VecX solve(core::VecX b) const;
  /// Orthogonal projection of x (all rows) onto the range of L, that of the matrix.
  core::VecX onto_range(const core::VecX& x) const;

 private:
  core::MatX factor_;       ///< L in its first `rank` columns, rows in `order`
  std::vector<int> order_;  ///< rows by pivot; those not kept last
  int rank_ = 0;
};

}  // namespace trocar::law
