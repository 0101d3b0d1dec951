#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// W_ii plus compliance of every row [m/N]. It is exactly 0 if nothing can move the row: all its
/// dofs are prescribed, and its gap cannot change.
VecX mobility(const Problem& problem);

/// Sets the multipliers of blocks without mobility `w` to those that their gaps ask for. Records in
/// `result` the first such block whose gap violates its law. Needs sets that follow no multiplier.
/// `tolerance`: a gap up to it counts as closed [m].
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result);

}  // namespace trocar::law
