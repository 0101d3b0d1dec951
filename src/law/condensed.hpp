#pragma once

#include <vector>

#include "law/problem.hpp"

namespace trocar::law {

struct RowSplit
{
  std::vector<int> bilateral, box;
};
RowSplit split_rows(const Problem& problem);

/// Spectral pseudo-inverse of a symmetric positive semidefinite matrix; eigenvalues below `cut`
/// times the largest are dropped.
MatX pseudo_inverse(const MatX& matrix, double cut);

/// The problem on the box rows alone, the bilateral rows eliminated exactly:
///   S = W_ff - W_fb W_bb⁻¹ W_bf,   s = g_f - W_fb W_bb⁻¹ g_b.
/// Redundant bilateral rows are found by pivoted Cholesky and left out; they are then satisfied by
/// the others when the rows are consistent, which the residual tells.
class Condensed
{
 public:
  explicit Condensed(const Problem& problem);

  const MatX& S() const { return S_; }          ///< [m/N]
  const VecX& s() const { return s_; }          ///< [m]
  const VecX& bound() const { return bound_; }  ///< [N]
  VecX start() const { return start_; }         ///< box multipliers to start from [N]
  /// Rank of S, measured against the W_ff it was made from.
  int box_rank() const { return reveal_rank(S_, box_scale_).rank; }
  int bilateral_rank() const { return bilateral_rank_; }
  bool bilateral_redundant() const { return redundant_; }

  /// All multipliers for given box multipliers. Of redundant bilateral rows the least-norm
  /// representative is returned when it is as accurate.
  VecX expand(const VecX& lambda_f) const;

 private:
  VecX bilateral(const VecX& lambda_f) const;

  const Problem* problem_;
  RowSplit rows_;
  std::vector<int> kept_;  ///< bilateral rows of full rank
  Eigen::LLT<MatX> W_kept_;
  MatX S_;
  VecX s_, bound_, start_;
  double box_scale_ = 0.0;  ///< largest diagonal entry of W_ff [m/N]
  int bilateral_rank_ = 0;
  bool redundant_ = false;
};

}  // namespace trocar::law
