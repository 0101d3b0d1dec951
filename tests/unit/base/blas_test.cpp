#include "base/blas.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace trocar::base {
namespace {

/// Numbers without a pattern, the same on every rank.
MatX numbers(Eigen::Index rows, Eigen::Index columns)
{
  return MatX::NullaryExpr(rows, columns, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.0 + 3.7 * static_cast<double>(i) + 1.3 * static_cast<double>(i * j));
  });
}

/// Rows of a larger array, whose columns lie further apart than the block is high.
Block part(const MatX& all, Eigen::Index first, Eigen::Index rows)
{
  return {all.data() + first, rows, all.cols(), Eigen::OuterStride<>(all.rows())};
}

TEST(DenseProducts, TakeBlocksOfALargerArray)
{
  const MatX all = numbers(9, 4), other = numbers(4, 3), tall = numbers(5, 2);
  const Block A = part(all, 2, 5);
  EXPECT_LT((product(A, other) - all.middleRows(2, 5) * other).norm(), 1e-14);
  EXPECT_LT((transposed_product(tall, A) - tall.transpose() * all.middleRows(2, 5)).norm(), 1e-14);
  MatX target = numbers(7, 3);
  const MatX before = target;
  const MatX right = numbers(6, 3);
  subtract_product(A, part(right, 1, 4), target.middleRows(1, 5));
  MatX expected = before;
  expected.middleRows(1, 5) -= all.middleRows(2, 5) * right.middleRows(1, 4);
  EXPECT_LT((target - expected).norm(), 1e-14);
}

TEST(DenseProducts, GramIsSymmetricAndItsSumLeavesTheUpperTriangle)
{
  const MatX A = numbers(6, 4);
  EXPECT_LT((gram(A) - A.transpose() * A).norm(), 1e-14);
  EXPECT_EQ(gram(A), MatX(gram(A).transpose()));
  MatX C = numbers(5, 5);
  const MatX before = C;
  add_gram(A, C.topLeftCorner(4, 4));
  MatX expected = before;
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) expected(i, j) += A.col(i).dot(A.col(j));
  EXPECT_LT((C - expected).norm(), 1e-14);
}

TEST(DenseProducts, SolveWithTheLowerTriangleAlone)
{
  MatX L = numbers(6, 4);  // above the diagonal stands anything
  L.diagonal(-1).array() += 3.0;
  MatX B = numbers(8, 2);
  const MatX X = B.middleRows(3, 4);
  const MatX lower = L.middleRows(1, 4).triangularView<Eigen::Lower>();
  B.middleRows(3, 4) = lower * X;
  solve_lower(part(L, 1, 4), B.middleRows(3, 4));
  EXPECT_LT((B.middleRows(3, 4) - X).norm(), 1e-13);
}

TEST(DenseProducts, OfNothingAreNothingOrZero)
{
  const MatX none(0, 4), empty(4, 0), some = numbers(4, 3);
  EXPECT_EQ(product(part(none, 0, 0), some).rows(), 0);
  EXPECT_EQ(product(part(empty, 0, 4), MatX(0, 3)), MatX(MatX::Zero(4, 3)));
  EXPECT_EQ(gram(MatX(0, 2)), MatX(MatX::Zero(2, 2)));
}

}  // namespace
}  // namespace trocar::base
