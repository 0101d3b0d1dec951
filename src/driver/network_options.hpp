#pragma once

#include <string>
#include <vector>

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// The cavity of that name; Failure (64) that names `option` and the nearest one.
int cavity_index(const std::vector<cavity::CavitySettings>& cavities, const std::string& name,
                 const std::string& option);

/// Conduits between the cavities that are read already, and outside. Throws Failure (64, 65).
/// Collective.
void read_network(core::Options& options, Scenario& scenario, const base::Comm& comm);

}  // namespace trocar::driver
