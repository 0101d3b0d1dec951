#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::Vec3;
using core::VecX;

/// A closed surface of triangles with 3 nodes (flat) or 6 (quadratic; Gmsh's order: corners, then
/// the middles of the edges 01, 12, 20). Normals point out of the enclosed volume. Except for
/// `face_shares`, the functions below take the coordinates x of the surface's vertices (3 ·
/// vertices) [m]. They are exact for curved faces too, but only if the surface is closed.
struct ClosedSurface
{
  int face_nodes = 3;
  std::vector<int> nodes;  ///< vertices of the faces, `face_nodes` of each

  std::size_t faces() const { return nodes.size() / static_cast<std::size_t>(face_nodes); }
};

/// ∫ N_a dA of the shape functions of one face [m²]: the nodal shares of a uniform load, exact for
/// flat faces. `x`: positions of the face's nodes (3 x 3 or 3 x 6) [m].
VecX face_shares(const MatX& x);

/// Volume V(x), a homogeneous cubic [m³] (fluid paper, eqs. 12, 13, by the divergence theorem).
double volume(const ClosedSurface& surface, const VecX& x);
/// g = ∂V/∂x [m²], the consistent nodal area vectors; g·x = 3V, Σg = 0.
VecX volume_gradient(const ClosedSurface& surface, const VecX& x);
/// ∂²V/∂x² d [m²] for d [m]: symmetric, linear in x.
VecX volume_hessian_times(const ClosedSurface& surface, const VecX& x, const VecX& d);

/// Q = ∫ φ·x dV over the enclosed volume, for φ in Pa/m [J]: potential of a hydrostatic pressure
/// φ·x.
double moment(const ClosedSurface& surface, const VecX& x, const Vec3& phi);
/// ∂Q/∂x: nodal forces of the pressure φ·x [N].
VecX moment_gradient(const ClosedSurface& surface, const VecX& x, const Vec3& phi);
/// ∂²Q/∂x² d [N] for d [m].
VecX moment_hessian_times(const ClosedSurface& surface, const VecX& x, const Vec3& phi,
                          const VecX& d);

/// Volume of the surface at y_0 + Σ p_j y_j, a cubic polynomial in the m numbers p. It is kept as
/// the symmetric tensor T_jkl = M(y_j, y_k, y_l), where M is the symmetric trilinear form for which
/// M(x, x, x) = V(x).
class VolumeCubic
{
 public:
  /// `y`: columns y_0 to y_m (3 · vertices x 1 + m).
  VolumeCubic(const ClosedSurface& surface, const MatX& y);

  double value(const VecX& p) const;   ///< [m³]
  VecX gradient(const VecX& p) const;  ///< (m) [m³ per unit of p]

 private:
  double at(Eigen::Index j, Eigen::Index k, Eigen::Index l) const;

  Eigen::Index size_;    ///< 1 + m
  std::vector<VecX> T_;  ///< vectors T_jk· over the last index, for j <= k
};

}  // namespace trocar::law
