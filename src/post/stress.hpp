#pragma once

#include "tissue/tissue.hpp"

namespace trocar::post {

using core::Vec3;
using core::VecX;
/// A stress with the components xx, yy, zz, xy, yz, xz [Pa].
using Voigt = Eigen::Matrix<double, 6, 1>;

/// Von Mises stress sqrt(3 J₂) [Pa].
double von_mises(const Voigt& stress);

/// Principal stresses in descending order [Pa].
Vec3 principal_values(const Voigt& stress);

/// Stress of a tet at its nodes [Pa], one node per column. It is constant in a linear tet, and
/// linear in a quadratic tet.
using NodalStress = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 10>;
NodalStress stress_at_nodes(const mesh::Mesh& mesh, const tissue::StressField& field, int tet);

/// Volume-weighted mean of the stress over the tets around every node (6 · nodes) [Pa]. A quadratic
/// tet counts with its stress at the node. `region`: takes only the tets of this volume of the
/// mesh, and nodes without such a tet get 0; -1: takes all tets. Not collective.
VecX nodal_means(const mesh::Mesh& mesh, const tissue::StressField& field, int region = -1);

}  // namespace trocar::post
