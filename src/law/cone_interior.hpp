#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Primal-dual interior point method for friction cones: forces and gaps inside their cones, with
/// the scaling of Nesterov and Todd and Mehrotra's corrector. De Saxcé's shift μ|δ_t| of the normal
/// gap is differentiated in the matrix; renewed from outside it would stall (docs/theory.md section
/// 14). Ends where rounding no longer lets it come nearer; `cone_newton` goes on from there. The
/// result is the best iterate, not judged. Sets: zero, interval, cone without limits.
Multipliers cone_interior(const Problem& problem, const Settings& settings);

/// True when every set of the problem is one that `cone_interior` knows.
bool all_for_cone_interior(const Problem& problem);

}  // namespace trocar::law
