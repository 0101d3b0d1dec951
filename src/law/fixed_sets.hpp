#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves a problem in which no set follows a multiplier (laws zero, interval and disc).
/// Multipliers of an interval are counted from its middle, and huge intervals are narrowed. Rows
/// that nothing can move are left out; `settle_immovable` gives them their multipliers.
Multipliers solve_fixed_sets(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
