#include <gtest/gtest.h>

#include "law/box_qp.hpp"
#include "law/schur_complement.hpp"
#include "support/problem.hpp"

namespace trocar::law {
namespace {

using test::random_problem;

TEST(BoxQp, WarmStartedActiveSetNeedsFewFactorisations)
{
  const Problem problem = random_problem(30, 120, 11);
  SchurComplement condensed(problem);
  const BoxSolution cold = active_set(condensed.qp(), condensed.start(), 1000);
  const BoxSolution warm = active_set(condensed.qp(), cold.x, 1000);
  EXPECT_TRUE(cold.finished);
  EXPECT_LE(cold.factorisations, 15);
  EXPECT_LE(warm.factorisations, 2);
  EXPECT_LT((warm.x - cold.x).norm(), 1e-12);
}

TEST(BoxQp, SetNewtonNeedsHardlyMoreThanOneFactorisationFromGoodSets)
{
  for (int rank : {120, 40}) {  // regular, and S singular
    const Problem problem = random_problem(30, rank, 11);
    SchurComplement condensed(problem);
    const BoxQp qp = condensed.qp();
    const BoxSolution cold = interior_point(qp, condensed.start(), 1e-13, 100);
    ASSERT_TRUE(cold.finished);
    EXPECT_LE(cold.factorisations, 20);
    const BoxSolution warm = primal_dual_active_set(qp, cold.x, 1e-9, 6);
    EXPECT_TRUE(warm.finished);
    EXPECT_LE(warm.factorisations, rank == 120 ? 1 : 2);
    EXPECT_LT(box_residual(qp, warm.x), 1e-12);
  }
}

TEST(BoxQp, SetNewtonGivesUpInsteadOfCycling)
{
  // From the wrong bounds everywhere; whatever it does, few factorisations and no false success.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = random_problem(30, 40, seed);
    SchurComplement condensed(problem);
    const BoxQp qp = condensed.qp();
    const VecX wrong = qp.s.cwiseSign().cwiseProduct(qp.bounds.F);
    const BoxSolution answer = primal_dual_active_set(qp, wrong, 1e-9, 6);
    EXPECT_LE(answer.factorisations, 6);
    if (answer.finished)
      EXPECT_LT(box_residual(qp, answer.x), 1e-9);
    else
      EXPECT_EQ(answer.x, wrong);
  }
}

// Redundant rows whose pivots round-off makes negative or nothing: there is none to prefer, and
// none but these may be written to.
TEST(BoxQp, RowsWithoutAPositivePivotAreReleasedAllTheSame)
{
  for (double pivot : {-1e-12, 0.0}) {
    MatX S = MatX::Constant(2, 2, pivot);
    const VecX s = VecX::Constant(2, 1.0), start = VecX::Constant(2, 1.0);
    const Bounds bounds{start, {}};
    const BoxSolution one = active_set({S, s, bounds}, start, 100);
    const auto energy = [&](const VecX& x) { return x.dot(0.5 * (S * x) + s); };
    EXPECT_LE(one.x.cwiseAbs().maxCoeff(), 1.0);
    EXPECT_LE(energy(one.x), energy(start));
  }
}

}  // namespace
}  // namespace trocar::law
