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
  problem.kind = {RowKind::box};
  problem.group = {0};
  problem.start = VecX::Zero(1);
  problem.bound = VecX::Constant(1, 1.0);
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
  problem.softness = VecX::Zero(problem.rows());
  for (Eigen::Index i = 0; i < problem.rows(); i += 3) problem.softness[i] = 2e-4;
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
    RowKind kind;
    double gap, bound, start, lambda;
  };
  const double open = std::numeric_limits<double>::infinity();
  for (const Case& c : {Case{RowKind::box, 1e-3, 2.0, 0.5, -2.0},
                        {RowKind::box, -1e-3, 2.0, 0.5, 2.0},
                        {RowKind::box, 0.0, 2.0, 0.5, 0.5},
                        {RowKind::box, 0.0, 2.0, 7.0, 2.0},
                        {RowKind::push, 1e-3, 2.0, 0.5, 0.0},
                        {RowKind::push, -1e-3, 2.0, 0.5, 2.0},
                        {RowKind::push, 0.0, open, 0.5, 0.5},
                        {RowKind::bilateral, 0.0, 0.0, 0.5, 0.5}})
    for (Method method : {Method::automatic, Method::hybrid, Method::pgs, Method::active_set,
                          Method::interior_point}) {
      Problem problem = random_problem(3, 20, 1);
      problem.W.row(0).setZero();
      problem.W.col(0).setZero();
      problem.kind[0] = c.kind;
      problem.g[0] = c.gap;
      problem.bound[0] = c.bound;
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
  const double open = std::numeric_limits<double>::infinity();
  for (RowKind kind : {RowKind::bilateral, RowKind::push}) {
    Problem problem = random_problem(3, 20, 1);
    problem.W.row(4).setZero();
    problem.W.col(4).setZero();
    problem.kind[4] = kind;
    problem.bound[4] = open;
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
  problem.kind[0] = RowKind::push;
  problem.bound[0] = 3.0;
  problem.g[0] = -1e-4;
  problem.kind[1] = RowKind::box;
  problem.g[1] = 1e-4;
  problem.normal.assign(9, -1);
  problem.normal[1] = 0;
  problem.friction = VecX::Zero(9);
  problem.friction[1] = 0.5;
  problem.bound[1] = 0.0;
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
  problem.kind = {RowKind::bilateral, RowKind::bilateral};
  problem.group = {0, 1};
  problem.bound = problem.start = VecX::Zero(2);
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
  problem.bound.setConstant(1e-3);  // so weak that nothing sticks
  const Multipliers cold = solve(problem, {.tolerance = 1e-12});
  ASSERT_TRUE(cold.converged) << cold.why;
  problem.start = cold.lambda;
  problem.start[2] *= -1.0;  // one row slipped the other way
  problem.start[5] = 0.0;    // one row is new
  problem.bound *= 1.1;      // all bounds grew
  const Multipliers warm = solve(problem, {.tolerance = 1e-12});
  EXPECT_TRUE(warm.converged) << warm.why;
  EXPECT_EQ(warm.iterations, 0);
  for (Eigen::Index i = 2; i < 30; i += 3) EXPECT_EQ(std::abs(warm.lambda[i]), problem.bound[i]);
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
