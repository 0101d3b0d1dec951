#include <algorithm>
#include <cmath>

#include "law/box_qp.hpp"

namespace trocar::law {

bool Bounds::of_pair(int row) const
{
  const auto next = std::upper_bound(pairs.begin(), pairs.end(), row);
  return next != pairs.begin() && row - *(next - 1) <= 1;
}

VecX Bounds::clip(const VecX& x) const
{
  VecX within = x.cwiseMax(-F).cwiseMin(F);
  for (int i : pairs) {
    const double length = x.segment<2>(i).norm();
    within.segment<2>(i) = x.segment<2>(i) * (length > F[i] ? F[i] / length : 1.0);
  }
  return within;
}

VecX Bounds::mean_diagonal(const MatX& S) const
{
  VecX w = S.diagonal().cwiseMax(1e-300);
  for (int i : pairs) w.segment<2>(i).setConstant(w.segment<2>(i).mean());
  return w;
}

double box_residual(const BoxQp& qp, const VecX& x)
{
  const Bounds& bounds = qp.bounds;
  const VecX gradient = qp.gradient(x);
  if (!gradient.allFinite()) return std::nan("");
  const VecX w = bounds.mean_diagonal(qp.S);
  const VecX natural = w.cwiseProduct(x - bounds.clip(x - gradient.cwiseQuotient(w)));
  double worst = natural.size() > 0 ? natural.cwiseAbs().maxCoeff() : 0.0;
  for (int i : bounds.pairs) worst = std::max(worst, natural.segment<2>(i).norm());
  return worst;
}

}  // namespace trocar::law
