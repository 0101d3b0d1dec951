#include <gtest/gtest.h>

#include "law/compare.hpp"
#include "support/problem.hpp"

namespace trocar::law {
namespace {

using test::random_problem;

TEST(Compare, AddsUpWhatEveryContenderNeeded)
{
  const Problem problem = random_problem(20, 62, 3);
  const std::vector<BenchmarkCase> contenders{
      {"hybrid", {.method = Method::hybrid, .max_iterations = 5}}, {"auto", {}}};
  std::vector<BenchmarkResult> trials;
  compare(problem, contenders, trials);
  compare(problem, contenders, trials);
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0].iterations, 10);
  EXPECT_GT(trials[0].residual, trials[1].residual);
  EXPECT_LE(trials[1].residual, 1e-9);
  for (const BenchmarkResult& trial : trials) EXPECT_GT(trial.factor_seconds, 0.0);
}

}  // namespace
}  // namespace trocar::law
