#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "law/solve.hpp"
#include "support/problem.hpp"

namespace trocar::law {
namespace {

using test::random_problem;

double energy(const Problem& p, const VecX& x)
{
  return 0.5 * x.dot(p.W * x) + p.g.dot(x);
}

TEST(Solvers, AllAgreeOnRegularProblems)
{
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = random_problem(6, 40, seed);
    VecX reference;
    for (Method method : {Method::active_set, Method::interior_point, Method::automatic,
                          Method::hybrid, Method::pgs}) {
      const Multipliers answer =
          solve(problem, {.method = method, .tolerance = 1e-10, .max_iterations = 20000});
      EXPECT_TRUE(answer.converged) << answer.why;
      EXPECT_LE(answer.residual, 1e-10);
      EXPECT_EQ(answer.rank, 18);
      EXPECT_FALSE(answer.nonunique);
      if (reference.size() == 0) reference = answer.lambda;
      EXPECT_LT((answer.lambda - reference).norm(), 1e-4 * reference.norm());
    }
  }
}

TEST(Solvers, SingularProblemsGiveUniqueGapsAndEnergy)
{
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = random_problem(8, 15, seed);
    const Multipliers one = solve(problem, {.method = Method::automatic, .tolerance = 1e-9});
    const Multipliers two =
        solve(problem, {.method = Method::hybrid, .tolerance = 1e-9, .max_iterations = 100000});
    ASSERT_TRUE(one.converged) << one.why;
    EXPECT_TRUE(one.nonunique);
    EXPECT_EQ(one.rank, 15);
    if (!two.converged) continue;  // the hybrid may well not get there: that is why auto exists
    EXPECT_LT((one.delta - two.delta).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_NEAR(energy(problem, one.lambda), energy(problem, two.lambda), 1e-9);
  }
}

TEST(Solvers, StickInsideTheBoxAndSlipOnIt)
{
  Problem problem;
  problem.W = MatX::Identity(1, 1) * 2.0;
  problem.blocks = {{0, Law::box(1.0), 0}};
  problem.start = VecX::Zero(1);
  for (Method method : {Method::pgs, Method::hybrid, Method::active_set, Method::interior_point}) {
    problem.g = VecX::Constant(1, -0.5);
    Multipliers answer = solve(problem, {.method = method});
    EXPECT_NEAR(answer.lambda[0], 0.25, 1e-9);
    EXPECT_NEAR(answer.delta[0], 0.0, 1e-9);
    problem.g = VecX::Constant(1, -5.0);
    answer = solve(problem, {.method = method});
    EXPECT_NEAR(answer.lambda[0], 1.0, 1e-9);
    EXPECT_NEAR(answer.delta[0], -3.0, 1e-8);
  }
}

TEST(Solvers, SoftRowsYieldInProportionToTheirForce)
{
  Problem problem = random_problem(6, 40, 5);
  problem.compliance = VecX::Zero(problem.rows());
  for (Eigen::Index i = 0; i < problem.rows(); i += 3) problem.compliance[i] = 2e-4;
  for (Method method : {Method::automatic, Method::hybrid, Method::pgs}) {
    const Multipliers answer =
        solve(problem, {.method = method, .tolerance = 1e-11, .max_iterations = 100000});
    ASSERT_TRUE(answer.converged) << answer.why;
    for (Eigen::Index i = 0; i < problem.rows(); i += 3)
      EXPECT_NEAR(answer.delta[i], -2e-4 * answer.lambda[i], 2e-11);
  }
}

// W_ii = 0 by every kind of row, opening, closed and closing, with every method.
TEST(Solvers, RowsThatNothingCanMoveGetWhatTheirGapAsksFor)
{
  struct Case
  {
    Law law;
    double gap, start, lambda;
  };
  for (const Case& c : {Case{Law::box(2.0), 1e-3, 0.5, -2.0},
                        {Law::box(2.0), -1e-3, 0.5, 2.0},
                        {Law::box(2.0), 0.0, 0.5, 0.5},
                        {Law::box(2.0), 0.0, 7.0, 2.0},
                        {Law::interval(0.0, 2.0), 1e-3, 0.5, 0.0},
                        {Law::interval(0.0, 2.0), -1e-3, 0.5, 2.0},
                        {Law::half_line(), 0.0, 0.5, 0.5},
                        {Law::zero(), 0.0, 0.5, 0.5}})
    for (Method method : {Method::automatic, Method::hybrid, Method::pgs, Method::active_set,
                          Method::interior_point}) {
      Problem problem = random_problem(3, 20, 1);
      problem.W.row(0).setZero();
      problem.W.col(0).setZero();
      problem.blocks[0].law = c.law;
      problem.g[0] = c.gap;
      problem.start[0] = c.start;
      const Multipliers answer =
          solve(problem, {.method = method, .tolerance = 1e-10, .max_iterations = 100000});
      ASSERT_TRUE(answer.converged) << answer.why;
      EXPECT_EQ(answer.lambda[0], c.lambda) << c.gap;
      EXPECT_EQ(answer.delta[0], c.gap);
    }
}

TEST(Solvers, AGapThatNothingCanCloseIsNotCalledMet)
{
  for (const Law& law : {Law::zero(), Law::half_line()}) {
    Problem problem = random_problem(3, 20, 1);
    problem.W.row(4).setZero();
    problem.W.col(4).setZero();
    problem.blocks[4].law = law;
    problem.g[4] = -1e-3;
    const Multipliers answer = solve(problem, {});
    EXPECT_FALSE(answer.converged);
    EXPECT_EQ(answer.immovable, 4);
    EXPECT_DOUBLE_EQ(answer.residual, 1e-3);
  }
}

// A friction row whose bound follows a normal one, both on a place that is held.
TEST(Solvers, FrictionOfAHeldPlaceFollowsItsNormalForce)
{
  Problem problem = random_problem(3, 20, 1);
  for (int row : {0, 1}) {
    problem.W.row(row).setZero();
    problem.W.col(row).setZero();
  }
  problem.blocks[0].law = Law::interval(0.0, 3.0);
  problem.g[0] = -1e-4;
  problem.blocks[1].law = Law::follower(0, 0.5);
  problem.g[1] = 1e-4;
  const Multipliers answer = solve(problem, {});
  ASSERT_TRUE(answer.converged) << answer.why;
  EXPECT_EQ(answer.lambda[0], 3.0);
  EXPECT_EQ(answer.lambda[1], -1.5);
}

TEST(Solvers, ContradictoryRowsAreNotCalledConverged)
{
  Problem problem;
  problem.W = MatX::Ones(2, 2);
  problem.g = VecX::Zero(2);
  problem.g[1] = 1e-3;  // the same row twice with different gaps
  problem.blocks = {{0, Law::zero(), 0}, {1, Law::zero(), 1}};
  problem.start = VecX::Zero(2);
  for (Method method : {Method::automatic, Method::pgs, Method::hybrid}) {
    const Multipliers answer = solve(problem, {.method = method});
    EXPECT_FALSE(answer.converged);
    EXPECT_FALSE(answer.why.empty());
  }
}

TEST(Solvers, StepNormStopsEarlierThanTheResidualAllows)
{
  const Problem problem = random_problem(20, 62, 3);
  const Multipliers step = solve(
      problem,
      {.method = Method::pgs, .norm = Norm::step, .tolerance = 1e-7, .max_iterations = 100000});
  EXPECT_TRUE(step.converged);
  EXPECT_GT(step.residual, 0.0);
  const Multipliers exact = solve(problem, {.method = Method::automatic, .tolerance = 1e-9});
  EXPECT_LT(exact.residual, step.residual);
}

TEST(Solvers, WhereAllRowsSlipTheBoxesNeedNoFactorisation)
{
  Problem problem = random_problem(10, 40, 4);
  const auto weaken = [&](double bound) {
    for (int i = 2; i < 30; i += 3) test::law_of(problem, i) = Law::box(bound);
  };
  weaken(1e-3);  // so weak that nothing sticks
  const Multipliers cold = solve(problem, {.tolerance = 1e-12});
  ASSERT_TRUE(cold.converged) << cold.why;
  problem.start = cold.lambda;
  problem.start[2] *= -1.0;  // one row slipped the other way
  problem.start[5] = 0.0;    // one row is new
  weaken(1.1e-3);            // all bounds grew
  const Multipliers warm = solve(problem, {.tolerance = 1e-12});
  EXPECT_TRUE(warm.converged) << warm.why;
  EXPECT_EQ(warm.iterations, 0);
  for (Eigen::Index i = 2; i < 30; i += 3) EXPECT_EQ(std::abs(warm.lambda[i]), 1.1e-3);
}

TEST(Solvers, SlippingRowsLieOnTheirBoundsWhateverTheMethod)
{
  // A row a hair inside its bound would count as stuck, and the point would not move.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = random_problem(30, 40, seed);
    for (Method method : {Method::automatic, Method::interior_point}) {
      const Multipliers answer = solve(problem, {.method = method});
      ASSERT_TRUE(answer.converged) << answer.why;
      EXPECT_LE(answer.iterations, 25);
      for (Eigen::Index i = 2; i < problem.rows(); i += 3)
        if (std::abs(answer.delta[i]) > 1e-8) {
          EXPECT_EQ(std::abs(answer.lambda[i]), 0.5);
        }
    }
  }
}

}  // namespace
}  // namespace trocar::law
