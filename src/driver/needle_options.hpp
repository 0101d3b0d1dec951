#pragma once

#include <vector>

#include "base/comm.hpp"
#include "core/options.hpp"
#include "mesh/locator.hpp"
#include "needle/needle.hpp"

namespace trocar::driver {

/// Reads all needles with their options and checks them against the undeformed mesh. Failure (64 or
/// 65) when a needle can never move as prescribed. `end`: end of the run [s]. Collective.
std::vector<needle::NeedleSettings> read_needles(core::Options& options, const mesh::Mesh& mesh,
                                                 const mesh::Locator& locator, double end,
                                                 const base::Comm& comm);

/// File nodes of the tets on the planned paths of the needles, and of up to `layers` rings of tets
/// around these tets. Rings are added while at most 1000 nodes (3000 dofs) result; the list is
/// empty when the paths alone have more, or when `layers` is 0. Between rows of a trajectory the
/// tip is assumed to move straight.
std::vector<int> planned_nodes(const std::vector<needle::NeedleSettings>& needles,
                               const mesh::Mesh& mesh, const mesh::Locator& locator, int layers);

}  // namespace trocar::driver
