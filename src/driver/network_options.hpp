#pragma once

#include <string>
#include <vector>

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// Index of a cavity by its name; -1 for "outside". Failure (64) for an unknown name; the message
/// names `option` and the most similar name.
int cavity_index(const std::vector<cavity::CavitySettings>& cavities, const std::string& name,
                 const std::string& option);

/// Reads the conduits between cavities, or a cavity and the outside. `scenario` must have its
/// cavities and needles. Throws Failure (64, 65). Collective.
void read_network(core::Options& options, Scenario& scenario, const base::Comm& comm);

}  // namespace trocar::driver
