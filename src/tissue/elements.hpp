#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/time_step.hpp"
#include "fem/block_matrix.hpp"
#include "tissue/material.hpp"

namespace trocar::tissue {

using core::Mat3;
using fem::GhostedField;
using fem::OwnedField;

enum class Mass { consistent, lumped };

/// Region over which the dilatation θ is averaged before it makes pressure. `pointwise`: no
/// average; such tets lock when they are nearly incompressible. `element`: the tet. `nodal`: the
/// tets around every corner node, separately in each volume of the mesh (Bonet and Burton 1998).
/// With quadratic tets `nodal` is Taylor-Hood with a lumped, eliminated pressure. `nodal` couples
/// all nodes around a corner.
enum class Dilatation { pointwise, element, nodal };

/// Quadratic tets with nodal dilatation apply λ up to this many μ to the pointwise θ, and only the
/// rest of λ to the average. Reason: a lumped pressure costs an order of convergence where λ is not
/// large, and up to λ = 10 μ (ν = 0.4545) nothing locks. Measured in docs/theory.md section 2.
inline constexpr double most_at_point = 10.0;

/// Rings of tets around its owned nodes that a rank needs (see fem::Space).
inline int overlap_layers(Dilatation dilatation)
{
  return dilatation == Dilatation::nodal ? 2 : 1;
}

struct ElementSettings
{
  Model model = Model::corotational;  ///< law of volumes whose material names none
  Mass mass = Mass::consistent;
  Dilatation dilatation = Dilatation::pointwise;
  Tangent tangent = Tangent::automatic;
  std::vector<Material> materials;  ///< by volume of the mesh

  Model model_of(std::size_t volume) const { return materials[volume].model.value_or(model); }
  /// Whether some volume has this model.
  bool any(Model one) const;
  /// Whether all volumes are linear: then the operator does not depend on the displacement.
  bool all_linear() const { return !any(Model::corotational) && !any(Model::neo_hookean); }
  /// Whether the operator is the full derivative of the forces: then it may be indefinite.
  bool exact_tangent() const
  {
    return any(Model::neo_hookean) || (any(Model::corotational) && tangent == Tangent::exact);
  }
};

/// State that the operator depends on, at every integration point of the local tets. A value type.
struct LinearisationPoint
{
  std::vector<Mat3> R;  ///< rotations; identities for linear tissue
  std::vector<Mat3> G;  ///< displacement gradients; empty unless the tangent is exact
  core::VecX p;         ///< pressures λθ of the tangent [Pa]; empty unless it is exact

  bool operator==(const LinearisationPoint& other) const;
};

/// Motion of the tissue. Inertia and mass damping together are M (a + α v).
struct Kinematics
{
  GhostedField u;       ///< [m]
  GhostedField v;       ///< [m/s]; empty: at rest
  GhostedField a;       ///< [m/s²]; empty: no inertia
  core::Rates rates{};  ///< rates from which v and a were computed
};

/// Forces on owned nodes, summed over tets.
struct ForceSums
{
  /// `internal`: forces of stress and stiffness damping; `inertia`: of inertia and mass damping
  /// [N].
  OwnedField internal, inertia;
  /// Forces of stiffness damping alone, without the part of an averaged θ̇; empty: not asked for
  /// [N].
  OwnedField damping{};
  /// `size`: sum over tets of the magnitude of their force on an owned node. `rounding`: bound on
  /// the rounding error of the force on the node, over the unit round-off. Empty: not asked for
  /// [N].
  core::VecX size{}, rounding{};
};

/// Elastic stress and energy density of tets, without damping.
struct StressField
{
  core::VecX stress;  ///< mean Cauchy stress xx, yy, zz, xy, yz, xz by tet (6 · tets) [Pa]
  /// Cauchy stress at the four corners, extrapolated linearly from the integration points (24 ·
  /// tets) [Pa]. Empty for linear tets, whose stress is constant.
  core::VecX corner;
  core::VecX energy;  ///< mean elastic energy per undeformed volume, by tet (tets) [J/m³]
};

/// Energies and damping powers, summed over the tets whose first node this rank owns.
struct TetWork
{
  double elastic = 0.0, kinetic = 0.0;                             ///< [J]
  double damping_power_mass = 0.0, damping_power_stiffness = 0.0;  ///< [W]
};

/// First inverted tet (det F <= 0) of linear tissue and first of other tissue, in file numbering;
/// -1: none. They are separate because the forces of linear tissue do not notice an inversion.
struct Folded
{
  int linear = -1, other = -1;
};

/// Sums over the tets of a rank: forces, operator, energies and stress, for linear or quadratic
/// tets and every material model. Borrows mesh and space. Nothing here is collective.
class Elements
{
 public:
  static std::unique_ptr<Elements> make(const mesh::Mesh& mesh, const fem::Space& space,
                                        const ElementSettings& settings);
  virtual ~Elements() = default;

  /// Sets of nodes that a nodal dilatation couples, in addition to the nodes of each tet.
  virtual const fem::Cliques& cliques() const = 0;

  /// The first inverted tets at the displacement u.
  virtual Folded folded(const GhostedField& u) const = 0;
  /// Sets the linearisation point `at` for the displacement u: rotations, for an exact tangent also
  /// G and p. False when a tet is inverted.
  virtual bool configure(const GhostedField& u, LinearisationPoint& at) const = 0;
  /// Pressures λ(θ + ∂θ/∂F : grad d) [Pa], linearised about `last` for the displacement increment
  /// d. Newton's method has these values when pressures are unknowns of their own. The tangent uses
  /// them instead of λθ at the new displacement, whose error is λ times the square of the strain
  /// increment.
  virtual core::VecX linearised_pressures(const LinearisationPoint& last,
                                          const GhostedField& d) const = 0;
  /// Sets in `at` what `add_forces_of` needs for the given tets: the rotations in these tets and in
  /// tets that share a dilatation with them. All other rotations are identities.
  virtual void configure_for(const std::vector<std::size_t>& tets, const GhostedField& u,
                             LinearisationPoint& at) const = 0;

  /// Adds K + β r_v K_v + (r_a + α) r_v M [N/m], with the rates r_v of velocity and r_a of
  /// acceleration. K_v is the stiffness of the viscous stress. It equals K where K is R K₀ Rᵀ.
  virtual void assemble(const LinearisationPoint& at, const core::Rates& rate,
                        const fem::BlockPattern& pattern, fem::BlockMatrix& values) const = 0;
  /// Product of the operator of `assemble` with d [N], computed element by element without a
  /// matrix, as if no dof were fixed.
  virtual OwnedField operate(const LinearisationPoint& at, const core::Rates& rate,
                             const GhostedField& d) const = 0;

  /// Adds the forces of stress, stiffness damping, inertia and mass damping of all tets to `sums`.
  virtual void add_forces(const LinearisationPoint& at, const Kinematics& motion,
                          ForceSums& sums) const = 0;
  /// Adds the same forces, but of the given tets only.
  virtual void add_forces_of(const std::vector<std::size_t>& tets, const LinearisationPoint& at,
                             const Kinematics& motion, ForceSums& sums) const = 0;
  /// Adds only the forces of inertia and mass damping [N].
  virtual void add_inertia(const Kinematics& motion, OwnedField& inertia) const = 0;
  /// Switches to the exact tangent or to the one with rotations held, from the next `configure` on.
  virtual void take(Tangent tangent) = 0;

  virtual TetWork work(const LinearisationPoint& at, const Kinematics& motion) const = 0;
  /// Stress and energy density, by local tet.
  virtual StressField stresses(const LinearisationPoint& at, const GhostedField& u) const = 0;

  /// Adds the weight to the nodes [N]: g ∫ρ N_a dV, or m_a g with lumped mass.
  virtual void add_weight(const core::Vec3& gravity, OwnedField& force) const = 0;
  /// Σ V R R_oldᵀ over the integration points of the tets around every local node [m³]. Nodes that
  /// touch linear tissue get the identity, because linear tissue does not turn.
  virtual std::vector<Mat3> turns(const std::vector<Mat3>& R,
                                  const std::vector<Mat3>& R_old) const = 0;
};

}  // namespace trocar::tissue
