#include "law/immovable.hpp"

#include <algorithm>
#include <cmath>

#include "core/words.hpp"

namespace trocar::law {

VecX mobility(const Problem& problem)
{
  // Prescribed dofs have exactly zero columns in W. A relative threshold would also catch rows of
  // stiff bodies beside very soft ones.
  VecX w = problem.W.diagonal().cwiseMax(0.0);
  if (problem.compliance.size() > 0) w += problem.compliance;
  return w;
}

// A row with W_ii = 0: no multiplier changes its gap, and its multiplier changes no other gap. If
// its gap is not zero, λ is at the end of its set that pushes against the gap. If the gap is zero
// (two bodies at rest), any λ of the set is a solution, and λ stays what it was. If the set has no
// such end (law zero, a push without limit), no λ answers the gap.
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result)
{
  constexpr double no_gap = 1e-12;  // [m], round-off: places are known to a part in 1e14
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
