#pragma once

#include "tissue/tissue.hpp"

namespace trocar::post {

using core::Vec3;
using core::VecX;
/// A stress xx, yy, zz, xy, yz, xz [Pa].
using Voigt = Eigen::Matrix<double, 6, 1>;

/// sqrt(3 J₂) [Pa].
double von_mises(const Voigt& stress);

/// Principal values, falling [Pa].
Vec3 principal_values(const Voigt& stress);

/// Stress of a tet at its nodes, one per column: constant, or linear in a quadratic tet [Pa].
using NodalStress = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 10>;
NodalStress stress_at_nodes(const mesh::Mesh& mesh, const tissue::StressField& field, int tet);

/// Means by volume of the stress in the tets around every node (6 · nodes) [Pa]: of quadratic ones
/// what it is at the node. Of one volume of the mesh alone, 0 where it has no tet, when a region is
/// named. Not collective.
VecX nodal_means(const mesh::Mesh& mesh, const tissue::StressField& field, int region = -1);

}  // namespace trocar::post
