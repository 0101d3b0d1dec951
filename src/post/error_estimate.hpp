#pragma once

#include <vector>

#include "post/stress.hpp"

namespace trocar::post {

/// Squares of the estimated energy error of every tet [J], by Zienkiewicz and Zhu (1987): the
/// stress against the field through the means at the nodes, which are taken for each volume by
/// itself. The estimate is of the discretisation of linear
/// elasticity; of large strains it is an indicator.
VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                     const tissue::StressField& field);

/// Edge lengths [m] of every node with which a mesh of the same elements would have the relative
/// error `target` with the fewest tets, if the error's density did not depend on the mesh
/// (Coorevits, Ladeveze and Pelle 1995): h_new / h = (target² E² / Σ e^(2d/(2p+d)))^(1/2p)
/// e^(-2/(2p+d)) of a tet with the error e, d = 3 and p the elements' order; between a quarter and
/// twice what it is, and scaled so that sizes meant at the nodes lead to the target, in terms of
/// what Gmsh makes of a size. `errors` as above, `energy` their sum with twice the energy, E² [J].
VecX wanted_sizes(const mesh::Mesh& mesh, const VecX& errors, double energy, double target);

/// How far a displacement is from what its mesh converges to.
struct ErrorEstimate
{
  VecX errors;                 ///< see recovery_errors [J]
  double energy = 0.0;         ///< twice the strain energy [J]
  double relative = 0.0;       ///< of the energy norm
  std::vector<double> part{};  ///< of the square, by volume of the mesh

  double sum() const { return errors.sum(); }
};
ErrorEstimate estimate_error(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                             const tissue::StressField& field);

}  // namespace trocar::post
