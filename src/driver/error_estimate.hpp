#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"

namespace trocar::driver {

/// Squares of the estimated energy error of every tet [J], by Zienkiewicz and Zhu (1987): the
/// stress against the field through the means at the nodes, which are taken for each volume by
/// itself. `stress`: see tissue::StressField. The estimate is of the discretisation of linear
/// elasticity; of large strains it is an indicator.
core::VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                           const core::VecX& stress);

/// -error_estimate: the error at the end of a run as a part of the energy norm, and every volume's
/// part in it, into the log and /error_estimate; against -error_target how much finer the mesh
/// would have to be. Collective.
void report_error(const Simulation& simulation, Recorder& recorder, const Log& log,
                  const State& state);

}  // namespace trocar::driver
