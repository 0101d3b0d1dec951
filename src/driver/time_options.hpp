#pragma once

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// Reads the kind of analysis, the steps and the limits on linearisations per step. Throws Failure
/// (64).
step::TimeSettings read_time(core::Options& options);

}  // namespace trocar::driver
