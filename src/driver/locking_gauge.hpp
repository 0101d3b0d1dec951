#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"

namespace trocar::driver {

/// -locking_gauge: dP/dV of every cavity over that with quadratic tets that do not lock (p2_bbar,
/// which costs what p2 costs), on the same mesh, in linear tissue at rest with the supports of the
/// scenario, each cavity by itself: into the log and /locking_gauge. Costs a factor of each; the
/// run's ledger does not count them. Collective.
void report_locking(const Simulation& simulation, Recorder& recorder, const Log& log);

}  // namespace trocar::driver
