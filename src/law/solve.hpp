#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves the dense problem by the chosen method. `automatic` tries several methods, the cheapest
/// first (theory 7). If none converges, the result says so; nothing is thrown. Pure: every rank
/// gets the same answer from the same input.
Multipliers solve(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
