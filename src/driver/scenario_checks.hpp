#pragma once

#include "driver/scenario.hpp"

namespace trocar::driver {

/// Throws Failure (64) for settings that are valid alone but not together. Adds warnings about
/// doubtful settings. Not collective.
void check_scenario(Scenario& scenario);

}  // namespace trocar::driver
