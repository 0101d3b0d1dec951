#pragma once

#include <vector>

#include "driver/simulation.hpp"
#include "io/results.hpp"

namespace trocar::driver {

/// The fields of stress that are asked for: /stress (tets, 6; Cauchy: xx, yy, zz, xy, yz, xz),
/// /von_mises, /principal_stress (tets, 3; falling), /strain_energy (tets), /nodal_stress
/// (nodes, 6; means of the tets around a node by volume). Collective.
std::vector<io::Field> stress_fields(const Simulation& simulation, const State& state);

/// Means by volume of the stress in the tets around every node (6 · nodes) [Pa]: of quadratic ones
/// what it is at the node. Of one volume of the mesh alone, 0 where it has no tet, when a region is
/// named. Not collective.
core::VecX nodal_means(const mesh::Mesh& mesh, const tissue::StressField& field, int region = -1);

/// Stress of a tet at its nodes, one per column: constant, or linear in a quadratic tet [Pa].
using NodalStress = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 10>;
NodalStress stress_at_nodes(const mesh::Mesh& mesh, const tissue::StressField& field, int tet);

/// sqrt(3 J₂) of a stress xx, yy, zz, xy, yz, xz [Pa].
double von_mises(const Eigen::Matrix<double, 6, 1>& stress);

/// Its principal values, falling [Pa].
Vec3 principal_values(const Eigen::Matrix<double, 6, 1>& stress);

}  // namespace trocar::driver
