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

}  // namespace trocar::law
