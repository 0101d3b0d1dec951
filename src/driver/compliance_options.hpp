#pragma once

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// Reads the -compliance_ options into `scenario.tissue`; `scenario.insertion` must be set before.
/// Failure (64) for choices that exclude each other.
void read_compliance(core::Options& options, Scenario& scenario);

}  // namespace trocar::driver
