#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Semismooth Newton's method on all rows of a problem with friction cones (Alart and Curnier
/// 1991), from its start. Every group is open, sticks or slips in an iteration; the slip's
/// direction and bound are differentiated. It is given up (not converged, without a reason) after
/// `most` factorisations, or when the residual is not finite. Sets: zero, interval, cone.
Multipliers cone_newton(const Problem& problem, const Settings& settings, int most);

/// True when every set of the problem is one that `cone_newton` knows, and some set is one-sided.
bool all_for_cone_newton(const Problem& problem);

}  // namespace trocar::law
