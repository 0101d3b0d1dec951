#pragma once

#include "driver/scenario.hpp"

namespace trocar::driver {

/// Refuses settings that are fine each and make no sense together, Failure (64); adds warnings
/// about those that are doubtful. Not collective.
void check_scenario(Scenario& scenario);

}  // namespace trocar::driver
