#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Answer to  min ½ xᵀSx + sᵀx,  |x_i| <= F_i.
struct BoxSolution
{
  VecX x;
  int factorisations = 0;
  bool finished = false;  ///< the method came to its own end; the caller judges the residual
};

/// Monotone active set for S positive definite: every iteration minimises over the free rows;
/// rows that leave the box stop at it (all at once while that lowers the energy, else the first
/// one met), rows with a multiplier of the wrong sign are released (all at once while the energy
/// falls, else the worst). Finite, because the energy never rises and sets do not repeat.
BoxSolution active_set(const MatX& S, const VecX& s, const VecX& F, const VecX& start,
                       int max_iterations);

/// Primal-dual interior point with Mehrotra's corrector; indifferent to a singular S. Scaled, so
/// that `tolerance` is relative to the largest gap or S F.
BoxSolution interior_point(const MatX& S, const VecX& s, const VecX& F, double tolerance,
                           int max_iterations);

}  // namespace trocar::law
