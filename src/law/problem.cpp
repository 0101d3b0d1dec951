#include "law/problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"

namespace trocar::law {

double kkt_residual(const Problem& problem, const VecX& lambda)
{
  const VecX delta = problem.W * lambda + problem.g;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const double w = problem.W(i, i);
    if (problem.kind[static_cast<std::size_t>(i)] == RowKind::bilateral) {
      worst = std::max(worst, std::abs(delta[i]));
    } else if (w <= 0.0) {
      const double asked = -std::copysign(problem.bound[i], delta[i]);
      if (std::abs(lambda[i] - asked) > 1e-9 * problem.bound[i])
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

namespace {

/// -1, 0, 1: at the lower end of its interval, within, at the upper one.
int place(RowKind kind, double bound, double lambda)
{
  constexpr double round_off = 1e-9;
  if (kind == RowKind::bilateral) return 0;
  const double least = kind == RowKind::push ? 0.0 : -bound;
  if (lambda >= bound * (1.0 - round_off)) return 1;
  return lambda <= least + bound * round_off ? -1 : 0;
}

}  // namespace

VecX response(const Problem& problem, const VecX& lambda, const VecX& dg)
{
  std::vector<int> held;
  for (int i = 0; i < static_cast<int>(problem.rows()); ++i)
    if (place(problem.kind[static_cast<std::size_t>(i)], problem.bound[i], lambda[i]) == 0)
      held.push_back(i);
  VecX change = VecX::Zero(problem.rows());
  if (held.empty()) return change;
  MatX W = problem.W(held, held);
  if (problem.softness.size() > 0) W.diagonal() += problem.softness(held);
  change(held) = -core::least_squares(W, dg(held));
  return change;
}

bool same_states(const Problem& problem, const VecX& a, const VecX& b)
{
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!problem.normal.empty() && problem.normal[at] >= 0 && problem.friction[i] > 0.0)
      return false;
    const RowKind kind = problem.kind[at];
    if (place(kind, problem.bound[i], a[i]) != place(kind, problem.bound[i], b[i])) return false;
  }
  return true;
}

}  // namespace trocar::law
