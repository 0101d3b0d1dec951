#pragma once

#include "insertion/coupling.hpp"

namespace trocar::insertion {

/// Adds the rows of a needle that is coupled along a line: for every group of hats two across the
/// shaft and one or two along it, in means over its stretch of path. What the mesh hides of the
/// tissue next to the shaft goes between them as a compliance.
std::vector<PointRows> add_line_rows(const Ground& ground, const InsertionState& state,
                                     const Iterate& at, constraint::Set& set);

}  // namespace trocar::insertion
