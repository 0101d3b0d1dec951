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
  std::map<int, Vec3> field{};     ///< by file node, instead of `value` [m]
};

/// Traction on the undeformed physical surface (dead load).
struct Traction
{
  std::string surface;
  Vec3 value;  ///< [Pa]
  std::optional<core::Csv> curve;
};

/// Everything that acts on the tissue from outside.
struct BoundaryConditions
{
  struct Fixed
  {
    std::string group;
    unsigned axes = 7;  ///< bits 1, 2, 4 for x, y, z
  };
  std::vector<Fixed> fixed;
  std::vector<PrescribedDisplacement> displacements;
  std::vector<Traction> tractions;
  Vec3 gravity = Vec3::Zero();  ///< [m/s²]
};

/// Throws Failure (65) where two groups prescribe different displacements for one node.
void refuse_conflicts(const BoundaryConditions& conditions, const mesh::Mesh& mesh);

/// The fixed set of these conditions. Throws Failure (65) for an unknown group.
fem::Dirichlet dirichlet_set(const BoundaryConditions& conditions, const mesh::Mesh& mesh,
                             const fem::Space& space);

/// Prescribed displacement of every constrained dof at time t, zero elsewhere [m].
fem::OwnedField prescribed_displacement(const BoundaryConditions& conditions,
                                        const mesh::Mesh& mesh, const fem::Space& space, double t);

/// Factor of a load at time t: its curve, or 1 without one.
double load_factor(const std::optional<core::Csv>& curve, double t);

/// Nodal forces of a uniform traction of 1 Pa times `value` on a surface [N]. Collective-free.
fem::OwnedField traction_load(const mesh::SurfaceGroup& surface, const Vec3& value,
                              const mesh::Mesh& mesh, const fem::Space& space);

/// Throws Failure (64) when a connected part of the mesh keeps a rigid motion: a static problem
/// would be singular.
void require_supports(const fem::Dirichlet& fixed, const mesh::Mesh& mesh);

}  // namespace trocar::tissue
