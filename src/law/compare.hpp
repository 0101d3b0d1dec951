#pragma once

#include <string>
#include <vector>

#include "law/problem.hpp"

namespace trocar::law {

/// A solver to be benchmarked. It solves problems of the run, but the run does not use its answers.
struct BenchmarkCase
{
  std::string name;  ///< of the solver, as the user wrote it
  Settings settings;
};

/// Cost and accuracy of one contender; iterations, failures and times are sums over its problems.
struct BenchmarkResult
{
  int iterations = 0;           ///< sweeps or factorisations
  int failures = 0;             ///< problems it did not solve
  double residual = 0.0;        ///< largest KKT residual [m]
  double seconds = 0.0;         ///< wall time of the iterations alone [s]
  double factor_seconds = 0.0;  ///< wall time of the pseudo-inverse or factor of W_bb [s]
};

/// Solves the problem with every contender and adds the results to `trials` (one per contender;
/// empty before the first call). A contender that does not converge counts as a failure; nothing is
/// thrown.
void compare(const Problem& problem, const std::vector<BenchmarkCase>& contenders,
             std::vector<BenchmarkResult>& trials);

}  // namespace trocar::law
