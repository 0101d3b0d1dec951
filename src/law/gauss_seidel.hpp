#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Projected Gauss-Seidel over coupling points, the paper's first solver: each sweep solves every
/// point's rows (two lateral, one axial) exactly with all others held.
Multipliers solve_pgs(const Problem& problem, const Settings& settings);

/// The paper's hybrid solver (eq. 4): each iteration solves all bilateral rows at once with the
/// spectral pseudo-inverse W_bb⁺ (relative cut 1e-10), then sweeps the friction rows.
Multipliers solve_hybrid(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
