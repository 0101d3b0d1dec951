#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves the dense problem by the chosen method. `automatic` condenses the bilateral rows and
/// takes the interior point when S is singular, else the active set; when the first one misses the
/// tolerance the other one tries. Not converging is an outcome, never an exception.
/// Pure: every rank gets the same answer from the same input.
Multipliers solve(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
