#pragma once

#include <optional>
#include <vector>

#include "law/box_qp.hpp"
#include "law/pivoted_cholesky.hpp"

namespace trocar::law {

/// Rows of a problem: `bilateral` are those of the law zero, `box` those with bounds (boxes and
/// discs).
struct RowSplit
{
  std::vector<int> bilateral, box;
  Bounds bounds;  ///< of the box rows, in their order
};
RowSplit split_rows(const Problem& problem);

/// Spectral pseudo-inverse of a symmetric positive semidefinite matrix; eigenvalues below `cut`
/// times the largest are dropped.
MatX pseudo_inverse(const MatX& matrix, double cut);

/// The problem on the box rows (f) alone; the bilateral rows (b) are eliminated exactly:
///   S = W_ff - W_fb W_bb⁻¹ W_bf,   s = g_f - W_fb W_bb⁻¹ g_b.
/// Pivoted Cholesky finds redundant bilateral rows, and they are left out. If the rows are
/// consistent, the other rows satisfy the redundant ones too; the residual shows whether they are.
class SchurComplement
{
 public:
  /// Factors W_bb; borrows the problem. S is made at the first call of `qp`, because it is not
  /// needed when every point slips.
  explicit SchurComplement(const Problem& problem);

  /// S, s and bounds, borrowed from this object.
  BoxQp qp();
  const Bounds& bounds() const { return rows_.bounds; }
  /// Multipliers of the box rows to start from [N]: those of the problem. A multiplier near its
  /// bound is put on the bound: the bound may have grown since the last step, and a row that
  /// slipped then probably still slips.
  const VecX& start() const { return start_; }
  int box_rows() const { return static_cast<int>(rows_.box.size()); }
  /// Rank of S; its pivots are compared with the largest diagonal entry of W_ff.
  int box_rank();
  int bilateral_rank() const { return W_bb_.rank(); }
  bool bilateral_redundant() const;
  double bilateral_condition() const { return W_bb_.condition(); }

  /// Multipliers of the box rows if all of these rows slip [N], found from `start` by solves with
  /// W_bb alone. Returns nothing if more than half of the rows start inside their bounds, if there
  /// are discs, or if the directions of slip do not settle in two attempts. The caller checks the
  /// residual.
  std::optional<VecX> all_slipping() const;

  /// All multipliers for given multipliers of the box rows [N]. If bilateral rows are redundant,
  /// returns the multipliers of least norm, unless they are less accurate.
  VecX expand(const VecX& lambda_f) const;

 private:
  void eliminate();
  VecX with_kept_rows(const VecX& lambda_f, VecX& delta) const;

  const Problem* problem_;
  RowSplit rows_;
  PivotedCholesky W_bb_;
  std::vector<int> kept_;  ///< bilateral rows that are not redundant
  MatX S_;                 ///< empty until `qp` is called
  VecX s_, start_;
};

}  // namespace trocar::law
