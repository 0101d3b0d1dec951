#pragma once

#include <string>
#include <vector>

#include "law/problem.hpp"

namespace trocar::law {

/// A method that solves every problem beside the one that drives the run.
struct BenchmarkCase
{
  std::string name;  ///< as the user wrote it
  Settings settings;
};

/// What a contender needed; over several problems iterations and seconds add up.
struct BenchmarkResult
{
  int iterations = 0;           ///< sweeps or factorisations
  int failures = 0;             ///< problems it did not solve
  double residual = 0.0;        ///< worst true KKT residual [m]
  double seconds = 0.0;         ///< of the iteration alone
  double factor_seconds = 0.0;  ///< of the pseudo-inverse or factor of W_bb, made before it
};

/// Solves the problem with every contender and adds what it needed to `trials` (by contender;
/// empty at first). Not converging is a figure like others.
void compare(const Problem& problem, const std::vector<BenchmarkCase>& contenders,
             std::vector<BenchmarkResult>& trials);

}  // namespace trocar::law
