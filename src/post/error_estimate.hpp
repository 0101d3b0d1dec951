#pragma once

#include <vector>

#include "post/stress.hpp"

namespace trocar::post {

/// Square of the energy error of every tet [J], estimated after Zienkiewicz and Zhu (1987): the
/// stress is compared with the field interpolated from its nodal means. The means are taken in each
/// volume of the mesh separately. The estimate covers the discretisation error of linear
/// elasticity. At large strains it is only an indicator.
VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                     const tissue::StressField& field);

/// Edge length at every node [m] with which a new mesh of the same kind of elements would have the
/// relative error `target` with the fewest tets (Coorevits, Ladeveze and Pelle 1995). Assumes that
/// the error density does not depend on the mesh. A tet with the error e gets
///   h_new / h = (target² E² / Σ e^(2d/(2p+d)))^(1/2p) e^(-2/(2p+d)),  d = 3, p: element order,
/// limited to between 1/4 and 2. The nodal means of these sizes are scaled until their predicted
/// error is the target, and divided by 1.2, because Gmsh's mean edge is 1.2 times the requested
/// size. `errors`: from `recovery_errors`. `energy`: E², sum of `errors` plus twice the strain
/// energy [J].
VecX wanted_sizes(const mesh::Mesh& mesh, const VecX& errors, double energy, double target);

/// Estimated discretisation error of a displacement.
struct ErrorEstimate
{
  VecX errors;                 ///< squared error of every tet, see recovery_errors [J]
  double energy = 0.0;         ///< twice the strain energy [J]
  double relative = 0.0;       ///< error over the energy norm, 0 to 1
  std::vector<double> part{};  ///< share of the squared error, by volume of the mesh

  double sum() const { return errors.sum(); }
};
ErrorEstimate estimate_error(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                             const tissue::StressField& field);

}  // namespace trocar::post
