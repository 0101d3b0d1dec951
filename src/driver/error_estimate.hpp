#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"

namespace trocar::driver {

/// Squares of the estimated energy error of every tet [J], by Zienkiewicz and Zhu (1987): the
/// stress against the field through the means at the nodes, which are taken for each volume by
/// itself. The estimate is of the discretisation of linear
/// elasticity; of large strains it is an indicator.
core::VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                           const tissue::StressField& field);

/// Edge lengths [m] of every node with which a mesh of the same elements would have the relative
/// error `target` with the fewest tets, if the error's density did not depend on the mesh
/// (Coorevits, Ladeveze and Pelle 1995): h_new / h = (target² E² / Σ e^(2d/(2p+d)))^(1/2p)
/// e^(-2/(2p+d)) of a tet with the error e, d = 3 and p the elements' order; between a quarter and
/// twice what it is, and scaled so that sizes meant at the nodes lead to the target, in terms of
/// what Gmsh makes of a size. `errors` as above, `energy` their sum with twice the energy, E² [J].
core::VecX wanted_sizes(const mesh::Mesh& mesh, const core::VecX& errors, double energy,
                        double target);

/// -error_estimate: the error at the end of a run as a part of the energy norm, and every volume's
/// part in it, into the log and /error_estimate, with the error of every tet; against
/// -error_target how much finer the mesh would have to be, and the sizes of the next mesh into
/// -error_size_field. Collective.
void report_error(const Simulation& simulation, Recorder& recorder, const Log& log,
                  const State& state);

}  // namespace trocar::driver
