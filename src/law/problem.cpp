#include "law/problem.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::law {

double kkt_residual(const Problem& problem, const VecX& lambda)
{
  const VecX delta = problem.W * lambda + problem.g;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const double w = problem.W(i, i);
    if (w <= 0.0) continue;
    if (problem.kind[static_cast<std::size_t>(i)] == RowKind::bilateral) {
      worst = std::max(worst, std::abs(delta[i]));
    } else {
      const double F = problem.bound[i];
      const double natural = lambda[i] - std::clamp(lambda[i] - delta[i] / w, -F, F);
      worst = std::max(worst, w * std::abs(natural));
    }
    if (std::isnan(delta[i])) return delta[i];
  }
  return worst;
}

RankReveal reveal_rank(MatX matrix, double scale, double cut)
{
  const Eigen::Index n = matrix.rows();
  RankReveal result;
  if (n == 0) return result;
  const double stop = cut * (scale > 0.0 ? scale : matrix.diagonal().maxCoeff());
  std::vector<int> order(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = static_cast<int>(i);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = 0;
    const double largest = matrix.diagonal().tail(n - k).maxCoeff(&pivot);
    if (!(largest > stop)) break;
    pivot += k;
    std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(pivot)]);
    matrix.row(k).swap(matrix.row(pivot));
    matrix.col(k).swap(matrix.col(pivot));
    const Eigen::Index rest = n - k - 1;
    const VecX column = matrix.col(k).tail(rest) / largest;
    matrix.bottomRightCorner(rest, rest).noalias() -= largest * column * column.transpose();
    result.rows.push_back(order[static_cast<std::size_t>(k)]);
  }
  result.rank = static_cast<int>(result.rows.size());
  std::sort(result.rows.begin(), result.rows.end());
  return result;
}

}  // namespace trocar::law
