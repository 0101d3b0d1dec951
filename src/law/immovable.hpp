#pragma once

#include "law/problem.hpp"

namespace trocar::law {

/// W_ii and compliance of every row [m/N], exactly 0 where nothing can move the row: all its dofs
/// are prescribed, its gap is what it is.
VecX mobility(const Problem& problem);

/// Gives blocks without mobility the multipliers that their gaps ask for, and says in `result`
/// where a gap breaks the law of such a block. No set follows a multiplier here. `tolerance`: of
/// gaps [m].
void settle_immovable(const Problem& problem, const VecX& w, double tolerance, Multipliers& result);

}  // namespace trocar::law
