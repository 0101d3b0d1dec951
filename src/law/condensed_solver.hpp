#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// Solves a problem of the laws zero, box and disc: rows of the law zero are eliminated, the
/// rest is a quadratic program within bounds.
Multipliers solve_condensed(const Problem& problem, const Settings& settings);

}  // namespace trocar::law
