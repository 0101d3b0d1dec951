#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Projected Gauss-Seidel over coupling points, the needle paper's first solver. Each sweep solves
/// the rows of every point (two lateral, one axial) exactly, with all other rows fixed. A disc
/// takes one projected gradient step instead.
Multipliers solve_pgs(const Problem& problem, const Settings& settings);

/// The needle paper's hybrid solver (eq. 4). Each iteration solves all bilateral rows at once with
/// the spectral pseudo-inverse W_bb⁺ (relative cut 1e-10), then sweeps over the friction rows.
Multipliers solve_hybrid(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
