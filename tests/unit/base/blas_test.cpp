#include "base/blas.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "core/stopwatch.hpp"

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

TEST(Library, IsTheFileThatTheProductIsIn)
{
  const std::string library = blas_library();
  EXPECT_TRUE(std::filesystem::is_regular_file(library)) << library;
  EXPECT_FALSE(std::filesystem::is_symlink(library)) << library;
}

TEST(Library, IsSlowOnlyWhenItIsNotTheMachine)
{
  const std::string debian = "/usr/lib/x86_64-linux-gnu/";
  EXPECT_TRUE(slow_blas(5e9, debian + "blas/libblas.so.3.11.0"));
  EXPECT_TRUE(slow_blas(5e9, ""));
  EXPECT_FALSE(slow_blas(50e9, debian + "blas/libblas.so.3.11.0"));  // whatever it is
  EXPECT_FALSE(slow_blas(5e9, debian + "openblas-serial/libblas.so.3"));
}

// Waiting, for a processor or for anything else, is not in the rate.
TEST(Library, IsTimedByTheProcessor)
{
  const core::Stopwatch wall;
  const core::ProcessorStopwatch processor;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GT(wall.seconds(), 0.099);
  EXPECT_LT(processor.seconds(), 0.05);
  double sum = 0.0;
  const core::ProcessorStopwatch work;
  for (int k = 0; work.seconds() < 0.02; ++k) sum += std::sin(k);
  EXPECT_GE(work.seconds(), 0.02);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace trocar::base
