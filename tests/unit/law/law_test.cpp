#include <gtest/gtest.h>

#include <random>

#include "law/box_qp.hpp"
#include "law/compare.hpp"
#include "law/condensed.hpp"
#include "law/gauss_seidel.hpp"
#include "law/solve.hpp"

namespace trocar::law {
namespace {

/// Random problem of `points` coupling points with two bilateral rows and a box row each; `rank`
/// below 3 * points makes W singular.
Problem random_problem(int points, int rank, unsigned seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](Eigen::Index rows, Eigen::Index columns) {
    return MatX::NullaryExpr(rows, columns, [&] { return normal(generator); }).eval();
  };
  Problem problem;
  const int rows = 3 * points;
  const MatX B = random(rows, rank);
  problem.W = 1e-3 * B * B.transpose() / rank;
  // Gaps in the range of W: bilateral rows are then consistent even when W is singular.
  problem.g = B * random(rank, 1) * 1e-3;
  problem.bound = VecX::Constant(rows, 0.5);
  problem.start = VecX::Zero(rows);
  for (int i = 0; i < rows; ++i) {
    problem.kind.push_back(i % 3 == 2 ? RowKind::box : RowKind::bilateral);
    problem.group.push_back(i / 3);
  }
  return problem;
}

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

TEST(Solvers, ARowThatNothingCanMoveHasNoForceAndKeepsItsGap)
{
  Problem problem = random_problem(3, 20, 1);
  problem.W.row(0).setZero();
  problem.W.col(0).setZero();
  const Multipliers answer = solve(problem, {});
  ASSERT_TRUE(answer.converged);
  EXPECT_EQ(answer.lambda[0], 0.0);
  EXPECT_EQ(answer.delta[0], problem.g[0]);
  EXPECT_EQ(answer.rank, 8);
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

TEST(PivotedCholesky, FindsTheRankAndARegularSubset)
{
  const Problem problem = random_problem(10, 13, 7);
  const PivotedCholesky factor(problem.W);
  EXPECT_EQ(factor.rank(), 13);
  const MatX part = problem.W(factor.kept(), factor.kept());
  EXPECT_EQ(Eigen::LLT<MatX>(part).info(), Eigen::Success);
  EXPECT_EQ(PivotedCholesky(MatX::Zero(4, 4)).rank(), 0);
}

TEST(BoxQp, WarmStartedActiveSetNeedsFewFactorisations)
{
  const Problem problem = random_problem(30, 120, 11);
  Condensed condensed(problem);
  const BoxSolution cold =
      active_set(condensed.S(), condensed.s(), condensed.bound(), condensed.start(), 1000);
  const BoxSolution warm =
      active_set(condensed.S(), condensed.s(), condensed.bound(), cold.x, 1000);
  EXPECT_TRUE(cold.finished);
  EXPECT_LE(cold.factorisations, 15);
  EXPECT_LE(warm.factorisations, 2);
  EXPECT_LT((warm.x - cold.x).norm(), 1e-12);
}

TEST(PivotedCholesky, ManyPanelsSolveOnKeptRowsAndProjectOntoTheRange)
{
  const Problem problem = random_problem(40, 75, 2);
  const PivotedCholesky factor(problem.W);
  ASSERT_EQ(factor.rank(), 75);
  const std::vector<int> kept = factor.kept();
  const VecX x = VecX::LinSpaced(75, -1.0, 1.0);
  EXPECT_LT((factor.solve(problem.W(kept, kept) * x) - x).norm(), 1e-6);
  const VecX in_range = problem.W * VecX::Ones(120);
  EXPECT_LT((factor.onto_range(in_range) - in_range).norm(), 1e-12 * in_range.norm());
  const VecX any = VecX::LinSpaced(120, 0.0, 1.0);
  EXPECT_LT((problem.W * (any - factor.onto_range(any))).norm(), 1e-12);
}

TEST(BoxQp, SetNewtonNeedsHardlyMoreThanOneFactorisationFromGoodSets)
{
  for (int rank : {120, 40}) {  // regular, and S singular
    const Problem problem = random_problem(30, rank, 11);
    Condensed condensed(problem);
    const MatX& S = condensed.S();
    const VecX &s = condensed.s(), &F = condensed.bound();
    const BoxSolution cold = interior_point(S, s, F, condensed.start(), 1e-13, 100);
    ASSERT_TRUE(cold.finished);
    EXPECT_LE(cold.factorisations, 20);
    const BoxSolution warm = set_newton(S, s, F, cold.x, 1e-9, 6);
    EXPECT_TRUE(warm.finished);
    EXPECT_LE(warm.factorisations, rank == 120 ? 1 : 2);
    EXPECT_LT(box_residual(S, s, F, warm.x), 1e-12);
  }
}

TEST(BoxQp, SetNewtonGivesUpInsteadOfCycling)
{
  // From the wrong bounds everywhere; whatever it does, few factorisations and no false success.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = random_problem(30, 40, seed);
    Condensed condensed(problem);
    const VecX& F = condensed.bound();
    const VecX wrong = condensed.s().cwiseSign().cwiseProduct(F);
    const BoxSolution answer = set_newton(condensed.S(), condensed.s(), F, wrong, 1e-9, 6);
    EXPECT_LE(answer.factorisations, 6);
    if (answer.finished)
      EXPECT_LT(box_residual(condensed.S(), condensed.s(), F, answer.x), 1e-9);
    else
      EXPECT_EQ(answer.x, wrong);
  }
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

TEST(Compare, AddsUpWhatEveryContenderNeeded)
{
  const Problem problem = random_problem(20, 62, 3);
  const std::vector<Contender> contenders{
      {"hybrid", {.method = Method::hybrid, .max_iterations = 5}}, {"auto", {}}};
  std::vector<Trial> trials;
  compare(problem, contenders, trials);
  compare(problem, contenders, trials);
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0].iterations, 10);
  EXPECT_GT(trials[0].residual, trials[1].residual);
  EXPECT_LE(trials[1].residual, 1e-9);
  for (const Trial& trial : trials) EXPECT_GT(trial.factor_seconds, 0.0);
}

}  // namespace
}  // namespace trocar::law
