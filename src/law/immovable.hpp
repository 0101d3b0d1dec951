#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// For every row i the sum of W_ii and the row's own compliance [m/N]. The sum is exactly 0 when
/// all dofs of the row are prescribed, so that its gap cannot change.
VecX mobility(const Problem& problem);

/// Sets the multipliers of blocks without mobility `w` to those that their gaps ask for. Records in
/// `result` the first such block whose gap violates its law. Needs sets that follow no multiplier.
/// `tolerance`: a gap up to it counts as closed [m].
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result);

}  // namespace trocar::law
