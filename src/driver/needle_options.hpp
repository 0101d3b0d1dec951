#pragma once

#include <vector>

#include "base/comm.hpp"
#include "core/options.hpp"
#include "mesh/locator.hpp"
#include "needle/needle.hpp"

namespace trocar::driver {

/// The needles of a scene with everything about them, checked against the undeformed mesh: a
/// needle that can never do what it is told is a Failure (64 or 65). `end` is the end of the run
/// [s]. Collective.
std::vector<needle::NeedleSettings> read_needles(core::Options& options, const mesh::Mesh& mesh,
                                                 const mesh::Locator& locator, double end,
                                                 const base::Comm& comm);

/// File nodes of the tets that the needles' planned paths go through, and of `layers` rings of
/// tets around those, as many as keep it below 3000 dofs. Trajectories are taken as the straight
/// ways of their tips from row to row; 0 layers give none.
std::vector<int> planned_nodes(const std::vector<needle::NeedleSettings>& needles,
                               const mesh::Mesh& mesh, const mesh::Locator& locator, int layers);

}  // namespace trocar::driver
