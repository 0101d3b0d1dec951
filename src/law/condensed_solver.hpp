#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves a problem with the laws zero, box and disc. The rows of law zero are eliminated; the
/// other rows form a quadratic program within bounds.
Multipliers solve_condensed(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
