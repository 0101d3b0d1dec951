#pragma once

#include "law/problem.hpp"

namespace trocar::test {

/// Random problem of `points` coupling points with two bilateral rows and a box row each; `rank`
/// below 3 * points makes W singular.
law::Problem random_problem(int points, int rank, unsigned seed);

/// The law of a row.
law::Law& law_of(law::Problem& problem, int row);

}  // namespace trocar::test
