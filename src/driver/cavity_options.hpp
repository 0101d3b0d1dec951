#pragma once

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// The mesh without the volumes that become cavities (-cavity_<n>_region). Throws Failure (64, 65).
/// Not collective.
mesh::Mesh with_cavities_hollow(core::Options& options, mesh::Mesh mesh);

/// Reads cavities, conduits and the P-V sweep, and checks them against mesh, tissue and needles of
/// the scenario. Throws Failure (64, 65). Collective.
void read_cavities(core::Options& options, Scenario& scenario, const base::Comm& comm);

}  // namespace trocar::driver
