#include "support/problem.hpp"

#include <random>
#include <stdexcept>

namespace trocar::test {

using core::MatX;
using core::VecX;
using law::Law;
using law::Problem;

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
  problem.start = VecX::Zero(rows);
  for (int i = 0; i < rows; ++i)
    problem.blocks.push_back({i, i % 3 == 2 ? Law::box(0.5) : Law::zero(), i / 3});
  return problem;
}

law::Law& law_of(Problem& problem, int row)
{
  for (law::Block& block : problem.blocks)
    if (row >= block.first && row < block.end()) return block.law;
  throw std::out_of_range("no such row");
}

}  // namespace trocar::test
