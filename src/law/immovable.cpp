#include "law/immovable.hpp"

#include <algorithm>
#include <cmath>

#include "core/words.hpp"

namespace trocar::law {

VecX mobility(const Problem& problem)
{
  // What is prescribed has columns that are exactly zero. A relative cut would also take rows of
  // stiff bodies beside very soft ones.
  VecX w = problem.W.diagonal().cwiseMax(0.0);
  if (problem.softness.size() > 0) w += problem.softness;
  return w;
}

// Rows that nothing can move, W_ii = 0: their gap is what it is, and no other row feels their
// multiplier. Where the gap opens, λ is at the end of its interval on that side; where it does
// not, between two bodies at rest, λ may be anything within and stays what it was. A bilateral
// row with a gap, or a push without limit, has no answer.
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result)
{
  constexpr double no_gap = 1e-12;  // [m], of places that are known to a part in 1e14
  const double closed = std::max(tolerance, no_gap);
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    if (w[i] > 0.0) continue;
    const RowKind kind = problem.kind[static_cast<std::size_t>(i)];
    const double gap = problem.g[i], F = problem.bound[i];
    const bool opens = std::abs(gap) > closed;
    const bool unlimited = kind == RowKind::bilateral || (gap < 0.0 && !std::isfinite(F));
    double& lambda = result.lambda[i];
    if (kind == RowKind::bilateral)
      lambda = problem.start[i];
    else if (!opens)
      lambda = std::clamp(problem.start[i], kind == RowKind::push ? 0.0 : -F, F);
    else if (gap > 0.0)
      lambda = kind == RowKind::push ? 0.0 : -F;
    else if (std::isfinite(F))
      lambda = F;
    if (!opens || !unlimited) continue;
    result.residual = std::max(result.residual, std::abs(gap));
    if (!result.converged) continue;
    result.converged = false;
    result.immovable = static_cast<int>(i);
    result.why = "a gap of " + core::shown(std::abs(gap)) + " m can be closed by nothing";
  }
}

}  // namespace trocar::law
