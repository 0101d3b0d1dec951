#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"

namespace trocar::driver {

/// dV/dp [m^3/Pa] of a cavity's wall in linear tissue at rest, statically, with the supports of the
/// scenario; other cavities empty. Collective.
double wall_compliance(const mesh::Mesh& mesh, const tissue::TissueSettings& settings,
                       const cavity::CavitySettings& cavity, const base::Comm& comm);

/// -locking_gauge: dP/dV of every cavity over that with quadratic tets that do not lock, on the
/// same mesh: into the log and /locking_gauge. Collective.
void report_locking(const Simulation& simulation, Recorder& recorder, const Log& log);

}  // namespace trocar::driver
