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
  if (problem.compliance.size() > 0) w += problem.compliance;
  return w;
}

// Rows that nothing can move, W_ii = 0: their gap is what it is, and no other row feels their
// multiplier. Where the gap opens, λ is at the end of its set on that side; where it does not,
// between two bodies at rest, λ may be anything within and stays what it was. A row without such
// an end, of the law zero or a push without limit, has no answer to a gap.
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result)
{
  constexpr double no_gap = 1e-12;  // [m], of places that are known to a part in 1e14
  const double closed = std::max(tolerance, no_gap);
  for (const Block& block : problem.blocks) {
    const int n = block.law.rows();
    if (w.segment(block.first, n).maxCoeff() > 0.0) continue;
    const Few gap = problem.g.segment(block.first, n),
              start = problem.start.segment(block.first, n);
    const bool opens = gap.norm() > closed;
    const Few end = resisting(block.law, gap);
    if (!opens)
      result.lambda.segment(block.first, n) = project(block.law, start);
    else
      result.lambda.segment(block.first, n) = end.allFinite() ? end : start;
    if (!opens || end.allFinite()) continue;
    result.residual = std::max(result.residual, gap.norm());
    if (!result.converged) continue;
    result.converged = false;
    result.immovable = block.first;
    result.why = "a gap of " + core::shown(gap.norm()) + " m can be closed by nothing";
  }
}

}  // namespace trocar::law
