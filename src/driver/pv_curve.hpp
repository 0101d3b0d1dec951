#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"

namespace trocar::driver {

/// -analysis pv_curve: equilibria with one cavity held at volumes from low to high, beginning at
/// that of the mesh in both directions; writes /pv_curve (volume ratio, pressure, straight line and
/// piecewise fit) and logs slope K_p and R² of the line (fluid paper figure 4). Failure (70) when a
/// point is not reached. Gives the state at the largest volume. Collective.
State run_pv_curve(Simulation& simulation, Recorder& recorder, Log& log, const State& start);

}  // namespace trocar::driver
