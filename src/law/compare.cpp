#include "law/compare.hpp"

#include <algorithm>

#include "law/solve.hpp"

namespace trocar::law {

void compare(const Problem& problem, const std::vector<BenchmarkCase>& contenders,
             std::vector<BenchmarkResult>& trials)
{
  trials.resize(contenders.size());
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    const Multipliers answer = solve(problem, contenders[i].settings);
    trials[i].iterations += answer.iterations;
    trials[i].failures += answer.converged ? 0 : 1;
    trials[i].residual = std::max(trials[i].residual, answer.residual);
    trials[i].seconds += answer.seconds;
    trials[i].factor_seconds += answer.factor_seconds;
  }
}

}  // namespace trocar::law
