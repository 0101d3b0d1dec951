#include <gtest/gtest.h>

#include "core/dense.hpp"
#include "law/pivoted_cholesky.hpp"
#include "support/problem.hpp"

namespace trocar::law {
namespace {

using test::random_problem;

TEST(PivotedCholesky, FindsTheRankAndARegularSubset)
{
  const Problem problem = random_problem(10, 13, 7);
  const PivotedCholesky factor(problem.W);
  EXPECT_EQ(factor.rank(), 13);
  const MatX part = problem.W(factor.kept(), factor.kept());
  EXPECT_TRUE(core::Cholesky(part).regular());
  EXPECT_EQ(PivotedCholesky(MatX::Zero(4, 4)).rank(), 0);
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

}  // namespace
}  // namespace trocar::law
