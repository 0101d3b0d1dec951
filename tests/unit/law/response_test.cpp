#include <gtest/gtest.h>

#include "law/solve.hpp"
#include "support/problem.hpp"

namespace trocar::law {
namespace {

// Between two answers in which the same rows hold and slip the multipliers change in proportion to
// the gaps: what `response` says of the first is the difference to the second.
TEST(Response, IsTheChangeOfTheMultipliers)
{
  int slipping = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Problem problem = test::random_problem(6, 40, seed);
    if (seed % 2 == 1) problem.compliance = VecX::Constant(problem.rows(), 1e-4);
    const Settings exact{.method = Method::automatic, .tolerance = 1e-13};
    const Multipliers before = solve(problem, exact);
    const VecX dg = 1e-6 * VecX::LinSpaced(problem.rows(), -1.0, 2.0);
    Problem moved = problem;
    moved.g += dg;
    const Multipliers after = solve(moved, exact);
    ASSERT_TRUE(before.converged && after.converged) << before.why << after.why;
    ASSERT_TRUE(same_states(problem, before.lambda, after.lambda, 1e-13)) << seed;
    const VecX change = after.lambda - before.lambda;
    EXPECT_LT((response(problem, before.lambda, dg, 1e-13) - change).norm(), 1e-5 * change.norm())
        << seed;
    for (Eigen::Index i = 2; i < problem.rows(); i += 3)
      slipping += std::abs(before.lambda[i]) >= 0.5 ? 1 : 0;
  }
  EXPECT_GT(slipping, 5);
}

}  // namespace
}  // namespace trocar::law
