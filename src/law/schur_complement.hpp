#pragma once

#include <optional>
#include <vector>

#include "law/box_qp.hpp"
#include "law/pivoted_cholesky.hpp"

namespace trocar::law {

/// Rows of the law `zero`, and those with bounds: boxes |λ| <= F and discs.
struct RowSplit
{
  std::vector<int> bilateral, box;
  Bounds bounds;  ///< of the box rows
};
RowSplit split_rows(const Problem& problem);

/// Spectral pseudo-inverse of a symmetric positive semidefinite matrix; eigenvalues below `cut`
/// times the largest are dropped.
MatX pseudo_inverse(const MatX& matrix, double cut);

/// The problem on the box rows alone, the bilateral rows eliminated exactly:
///   S = W_ff - W_fb W_bb⁻¹ W_bf,   s = g_f - W_fb W_bb⁻¹ g_b.
/// Redundant bilateral rows are found by pivoted Cholesky and left out; they are then satisfied by
/// the others when the rows are consistent, which the residual tells.
class SchurComplement
{
 public:
  /// Factors W_bb. S is made when it is first asked for: where every point slips nobody does.
  explicit SchurComplement(const Problem& problem);

  /// S, s and bounds, good while this lives.
  BoxQp qp();
  const Bounds& bounds() const { return rows_.bounds; }
  /// Box multipliers to start from: the problem's own, those near a bound put on it, because a
  /// slipping point's bound may grow from step to step [N].
  const VecX& start() const { return start_; }
  int box_rows() const { return static_cast<int>(rows_.box.size()); }
  /// Rank of S, measured against the W_ff it was made from.
  int box_rank();
  int bilateral_rank() const { return W_bb_.rank(); }
  bool bilateral_redundant() const;
  double bilateral_condition() const { return W_bb_.condition(); }

  /// Box multipliers when all of these rows slip, found from the start by solves with W_bb alone;
  /// nothing when one sticks, or the way they slip does not settle at once.
  std::optional<VecX> all_slipping() const;

  /// All multipliers for given box multipliers. Of redundant bilateral rows the least-norm
  /// representative is returned when it is as accurate.
  VecX expand(const VecX& lambda_f) const;

 private:
  void eliminate();
  VecX with_kept_rows(const VecX& lambda_f, VecX& delta) const;

  const Problem* problem_;
  RowSplit rows_;
  PivotedCholesky W_bb_;
  std::vector<int> kept_;  ///< bilateral rows of full rank
  MatX S_;                 ///< empty until asked for
  VecX s_, start_;
};

}  // namespace trocar::law
