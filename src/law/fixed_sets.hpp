#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves a problem whose sets follow no multiplier: laws zero, interval and disc. Intervals are
/// counted from their middles, huge ones drawn in; rows that nothing can move are left out and get
/// what their gap asks for.
Multipliers solve_fixed_sets(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
