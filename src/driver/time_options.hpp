#pragma once

#include "core/options.hpp"
#include "driver/scenario.hpp"

namespace trocar::driver {

/// Kind of analysis, steps, and how often each is linearised. Throws Failure (64).
step::TimeSettings read_time(core::Options& options);

}  // namespace trocar::driver
