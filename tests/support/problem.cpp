#include "support/problem.hpp"

#include <random>

namespace trocar::test {

using core::MatX;
using core::VecX;
using law::Problem;
using law::RowKind;

law::Problem random_problem(int points, int rank, unsigned seed)
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

}  // namespace trocar::test
