#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::Vec3;
using core::VecX;

/// A closed oriented surface of triangles with 3 nodes (flat) or 6 (quadratic, Gmsh's order:
/// corners, then the middles of edges 01, 12, 20), normals out of what it encloses. All functions
/// below take the coordinates of its vertices, x (3 · vertices) [m]; they are exact for the
/// surface as it is, and depend on it being closed.
struct ClosedSurface
{
  int face_nodes = 3;
  std::vector<int> nodes;  ///< vertices of the faces, `face_nodes` for each

  std::size_t faces() const { return nodes.size() / static_cast<std::size_t>(face_nodes); }
};

/// ∫ N_a dA of the shape functions of one face with these node positions (3, 3 or 6) [m²]: shares
/// of a uniform load; exact for flat faces.
VecX face_shares(const MatX& x);

/// Volume V(x), a homogeneous cubic [m³] (paper eqs. 12, 13 by the divergence theorem).
double volume(const ClosedSurface& surface, const VecX& x);
/// g = ∂V/∂x [m²]: the consistent nodal share of the area normals; g·x = 3V, Σg = 0.
VecX volume_gradient(const ClosedSurface& surface, const VecX& x);
/// ∂²V/∂x² d [m²] for d [m]: symmetric, linear in x.
VecX volume_hessian_times(const ClosedSurface& surface, const VecX& x, const VecX& d);

/// Q = ∫ φ·x dV [φ m⁴] over what is enclosed: potential of a pressure φ·x that grows with depth.
double moment(const ClosedSurface& surface, const VecX& x, const Vec3& phi);
/// ∂Q/∂x: nodal forces of the pressure φ·x [φ m³].
VecX moment_gradient(const ClosedSurface& surface, const VecX& x, const Vec3& phi);
/// ∂²Q/∂x² d.
VecX moment_hessian_times(const ClosedSurface& surface, const VecX& x, const Vec3& phi,
                          const VecX& d);

/// Volume of the surface at y_0 + Σ p_j y_j, a cubic in the m numbers p, kept as the symmetric
/// tensor T_jkl = M(y_j, y_k, y_l) of V(x) = M(x, x, x).
class VolumeCubic
{
 public:
  /// `y`: (3 · vertices, 1 + m).
  VolumeCubic(const ClosedSurface& surface, const MatX& y);

  double value(const VecX& p) const;   ///< [m³]
  VecX gradient(const VecX& p) const;  ///< (m) [m³ per unit of p]

 private:
  double at(Eigen::Index j, Eigen::Index k, Eigen::Index l) const;

  Eigen::Index size_;    ///< 1 + m
  std::vector<VecX> T_;  ///< T_jk· for j <= k
};

}  // namespace trocar::law
