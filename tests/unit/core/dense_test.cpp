#include "core/dense.hpp"

#include <gtest/gtest.h>

namespace trocar::core {
namespace {

TEST(Cholesky, SolvesAsManyColumnsAsThereAre)
{
  MatX A(3, 3);
  A << 4, 1, 0, 1, 3, -1, 0, -1, 2;
  Cholesky factor;
  factor.compute(A);
  ASSERT_TRUE(factor.regular());
  const MatX X = factor.solve(MatX(MatX::Identity(3, 3)));
  EXPECT_LT((A * X - MatX::Identity(3, 3)).norm(), 1e-15);
  const VecX b = VecX::LinSpaced(3, 1.0, 2.0);
  EXPECT_LT((A * factor.solve(b) - b).norm(), 1e-15);
  EXPECT_LT((Square(A).solve(b) - factor.solve(b)).norm(), 1e-15);
  EXPECT_EQ(factor.solve(MatX(3, 0)).cols(), 0);  // a needle that nothing touches
  EXPECT_EQ(factor.solve(MatX(3, 0)).rows(), 3);
}

TEST(Cholesky, TellsOfAPivotThatIsNotPositive)
{
  MatX A = MatX::Identity(3, 3);
  A(1, 1) = -1e-3;
  Cholesky factor;
  factor.compute(A);
  EXPECT_FALSE(factor.regular());
}

}  // namespace
}  // namespace trocar::core
