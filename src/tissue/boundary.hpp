#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/csv.hpp"
#include "fem/dirichlet.hpp"

namespace trocar::tissue {

using core::Vec3;

/// Displacement prescribed on a physical surface or point group; axes with NaN are free.
struct PrescribedDisplacement
{
  std::string group;
  Vec3 value;                      ///< [m]
  std::optional<core::Csv> curve;  ///< factor over time (columns time, factor)
  std::map<int, Vec3> field{};     ///< displacement by file node; replaces `value` unless empty [m]
};

/// Dead load: force per undeformed area on a physical surface.
struct Traction
{
  std::string surface;
  Vec3 value;  ///< [Pa]
  std::optional<core::Csv> curve;
};

/// Supports, prescribed displacements and loads of the tissue.
struct BoundaryConditions
{
  struct Fixed
  {
    std::string group;
    unsigned axes = 7;  ///< fixed axes: bits 1, 2, 4 for x, y, z
  };
  std::vector<Fixed> fixed;
  std::vector<PrescribedDisplacement> displacements;
  std::vector<Traction> tractions;
  Vec3 gravity = Vec3::Zero();  ///< [m/s²]
};

/// Throws Failure (65) where two groups prescribe different displacements for one axis of a node.
void refuse_conflicts(const BoundaryConditions& conditions, const mesh::Mesh& mesh);

/// The dofs that supports and prescribed displacements fix. Throws Failure (65) for an unknown
/// group.
fem::Dirichlet dirichlet_set(const BoundaryConditions& conditions, const mesh::Mesh& mesh,
                             const fem::Space& space);

/// Prescribed displacement of every constrained dof at time t, zero elsewhere [m].
fem::OwnedField prescribed_displacement(const BoundaryConditions& conditions,
                                        const mesh::Mesh& mesh, const fem::Space& space, double t);

/// Factor of a load or prescribed displacement at time t; 1 without a curve.
double load_factor(const std::optional<core::Csv>& curve, double t);

/// Nodal forces of the uniform traction `value` [Pa] on a surface [N]. Not collective.
fem::OwnedField traction_load(const mesh::SurfaceGroup& surface, const Vec3& value,
                              const mesh::Mesh& mesh, const fem::Space& space);

}  // namespace trocar::tissue
