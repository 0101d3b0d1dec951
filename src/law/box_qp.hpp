#pragma once

#include <vector>

#include "law/problem.hpp"

namespace trocar::law {

/// The admissible x: |x_i| <= F_i for a single row i, and |(x_i, x_i+1)| <= F_i for a pair of rows
/// (i, i+1), whose two F are equal.
struct Bounds
{
  VecX F;                  ///< (rows) [N]
  std::vector<int> pairs;  ///< first row of every pair, ascending

  bool of_pair(int row) const;  ///< whether the row belongs to a pair
  VecX clip(const VecX& x) const;
  /// S_ii of every single row, and for both rows of a pair the mean of their S_ii [m/N]; > 0.
  VecX mean_diagonal(const MatX& S) const;
};

/// min ½ xᵀSx + sᵀx within bounds. Borrows S, s and the bounds.
struct BoxQp
{
  const MatX& S;         ///< symmetric positive semidefinite (rows x rows) [m/N]
  const VecX& s;         ///< (rows) [m]
  const Bounds& bounds;  ///< of x

  VecX gradient(const VecX& x) const { return S * x + s; }
};

/// Answer to a quadratic program within bounds.
struct BoxSolution
{
  VecX x;  ///< (rows) [N]
  int factorisations = 0;
  bool finished = false;  ///< the method met its own criterion; the caller checks the residual
};

/// Primal-dual active set method (Newton's method on the sets), for bounds without pairs. Every
/// iteration minimises over the free rows. Then it puts all rows outside the box on their bounds
/// and frees all held rows where the negative gradient points inwards. From good sets it needs one
/// or two factorisations. From bad sets it may cycle, so callers limit the iterations and have a
/// fallback. S may be singular: a small proximal shift towards the start makes the minimum unique.
/// The shift changes the gradient by at most `tolerance` / 5 [m]. What a regular S determines stays
/// exact. When not finished, `x` is the start, clipped to the bounds.
BoxSolution primal_dual_active_set(const BoxQp& qp, const VecX& start, double tolerance,
                                   int max_iterations);

/// Semismooth Newton method on the natural map, for bounds with pairs. A pair that slips stays on
/// its circle; at the solution its stiffness along the circle is |gradient| / F. Finished when the
/// box residual is below `tolerance` / 10. Gives up when three iterations in a row each change at
/// least as many rows as the best earlier iteration. When not finished, `x` is the start.
BoxSolution pair_newton(const BoxQp& qp, const VecX& start, double tolerance, int max_iterations);

/// Monotone active set method, for S positive definite and bounds without pairs. Every iteration
/// minimises over the free rows. Rows that leave the box stop at their bounds: all at once, if this
/// gives no higher energy than stopping where the first row meets its bound; else that row alone.
/// Rows with a multiplier of the wrong sign are freed: all at once while the energy falls, else
/// one. The number of iterations is finite, because the energy never rises and no set occurs twice.
BoxSolution active_set(const BoxQp& qp, const VecX& start, int max_iterations);

/// Primal-dual interior point method with Mehrotra's corrector; S may be singular. The start is
/// moved to the inside of the bounds. In the result, rows that tend to a bound are put exactly on
/// it. Finished when the box residual of this result is below `tolerance` [m].
BoxSolution interior_point(const BoxQp& qp, const VecX& start, double tolerance,
                           int max_iterations);

/// Largest w |x - clip(x - (S x + s) / w)| of a row or pair [m], with w from `mean_diagonal`; NaN
/// when the gradient is not finite.
double box_residual(const BoxQp& qp, const VecX& x);

}  // namespace trocar::law
