#pragma once

#include <vector>

#include "law/problem.hpp"

namespace trocar::law {

/// Where x may be: |x_i| <= F_i, row by row, and of every pair (i, i+1), whose F are alike, the
/// length |(x_i, x_i+1)| <= F_i.
struct Bounds
{
  VecX F;                  ///< (rows) [N]
  std::vector<int> pairs;  ///< first rows, ascending

  bool of_pair(int row) const;  ///< the first or second of one
  VecX clip(const VecX& x) const;
  /// S_ii of every row, of a pair the mean of its two [m/N], > 0.
  VecX mean_diagonal(const MatX& S) const;
};

/// min ½ xᵀSx + sᵀx within bounds. Borrows all three.
struct BoxQp
{
  const MatX& S;         ///< symmetric positive semidefinite (rows x rows) [m/N]
  const VecX& s;         ///< (rows) [m]
  const Bounds& bounds;  ///< of all rows

  VecX gradient(const VecX& x) const { return S * x + s; }
};

/// Answer to a quadratic program within bounds.
struct BoxSolution
{
  VecX x;  ///< (rows) [N]
  int factorisations = 0;
  bool finished = false;  ///< the method came to its own end; the caller judges the residual
};

/// Newton's iteration on the sets (primal-dual active set), for bounds without pairs: every
/// iteration minimises over the free rows, then rows outside the box go on it and rows pulled
/// inwards are released, all at once. From good sets it needs one or two factorisations; from bad
/// ones it may cycle, so callers give it few and have another method behind it. S may be singular:
/// a shift towards the start (proximal point) makes the minimum unique, so small that the gradient
/// it leaves is at most `tolerance` / 5 [m]; what a regular S determines is exact. `x` is the start
/// when not finished.
BoxSolution primal_dual_active_set(const BoxQp& qp, const VecX& start, double tolerance,
                                   int max_iterations);

/// The same with pairs (semismooth Newton on the natural map): a pair that slips stays on its
/// circle, along which the gradient's length is its stiffness. Ends when the box residual is below
/// `tolerance` / 10; given up when no fewer rows change for the third time. `x` is the start when
/// not finished.
BoxSolution pair_newton(const BoxQp& qp, const VecX& start, double tolerance, int max_iterations);

/// Monotone active set for S positive definite and bounds without pairs: every iteration minimises
/// over the free rows; rows that leave the box stop at it (all at once while that lowers the
/// energy, else the first one met), rows with a multiplier of the wrong sign are released (all at
/// once while the energy falls, else the worst). Finite, because the energy never rises and sets do
/// not repeat.
BoxSolution active_set(const BoxQp& qp, const VecX& start, int max_iterations);

/// Primal-dual interior point with Mehrotra's corrector from a start drawn into the bounds;
/// indifferent to a singular S. Rows that tend to a bound are put on it; ends when the box residual
/// of that is below `tolerance` [m].
BoxSolution interior_point(const BoxQp& qp, const VecX& start, double tolerance,
                           int max_iterations);

/// Largest w |x - clip(x - (S x + s) / w)| of rows and pairs, w their mean diagonal [m].
double box_residual(const BoxQp& qp, const VecX& x);

}  // namespace trocar::law
