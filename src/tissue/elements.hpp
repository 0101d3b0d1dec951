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

/// Over what the dilatation θ is averaged before it makes pressure. Tets that take it pointwise
/// lock when they are nearly incompressible. `nodal`: the mean over the tets around every corner
/// node, each volume of the mesh apart (Bonet and Burton 1998; with quadratic tets Taylor-Hood with
/// a lumped pressure, eliminated): it couples all nodes around a corner.
enum class Dilatation { pointwise, element, nodal };

/// Of λ of quadratic tets with nodal dilatation this many μ stay at the points: to lump a pressure
/// costs an order of convergence where λ is not large, and up to there (ν = 0.4545) nothing locks.
/// Measured: docs/theory.md.
inline constexpr double most_at_point = 10.0;

/// Rings of tets that a rank needs around its nodes (see fem::Space).
inline int overlap_layers(Dilatation dilatation)
{
  return dilatation == Dilatation::nodal ? 2 : 1;
}

struct ElementSettings
{
  Model model = Model::corotational;  ///< of the volumes whose material names none
  Mass mass = Mass::consistent;
  Dilatation dilatation = Dilatation::pointwise;
  Tangent tangent = Tangent::automatic;
  std::vector<Material> materials;  ///< by volume of the mesh

  Model model_of(std::size_t volume) const { return materials[volume].model.value_or(model); }
  /// Some volume has this model.
  bool any(Model one) const;
  /// No volume has another model: the operator is the same everywhere.
  bool all_linear() const { return !any(Model::corotational) && !any(Model::neo_hookean); }
  /// The operator is the whole derivative of the forces: it may be indefinite.
  bool exact_tangent() const
  {
    return any(Model::neo_hookean) || (any(Model::corotational) && tangent == Tangent::exact);
  }
};

/// Where the tissue is linearised: what the operator depends on, by integration point of the local
/// tets. A value.
struct LinearisationPoint
{
  std::vector<Mat3> R;  ///< rotations; identities for linear tissue
  std::vector<Mat3> G;  ///< displacement gradients and
  core::VecX p;         ///< pressures λθ [Pa], where the tangent depends on them

  bool operator==(const LinearisationPoint& other) const;
};

/// Displacement with velocity and what else inertia acts on, w = a + α v.
struct Kinematics
{
  GhostedField u;       ///< [m]
  GhostedField v;       ///< [m/s]; empty: at rest
  GhostedField a;       ///< [m/s²]; empty: no inertia
  core::Rates rates{};  ///< that v and a were differenced with
};

/// Forces on owned nodes, summed over tets.
struct ForceSums
{
  OwnedField internal, inertia;  ///< of stress and stiffness damping; of mass and its damping [N]
  OwnedField damping{};          ///< of stiffness damping alone; empty: not asked for [N]
  /// Σ over tets of the length of their force on a node, and a bound of what rounding can make of
  /// it, over the unit round-off (owned nodes each); empty: not asked for [N].
  core::VecX size{}, rounding{};
};

/// Elastic stress and energy density of tets.
struct StressField
{
  core::VecX stress;  ///< mean Cauchy: xx, yy, zz, xy, yz, xz of each (6 · tets) [Pa]
  core::VecX corner;  ///< at the four corners, continued linearly from the integration points
                      ///< (24 · tets) [Pa]; empty for linear tets, where it is constant
  core::VecX energy;  ///< mean per undeformed volume (tets) [J/m³]
};

/// Energies of the tets that this rank counts, those whose first node it owns.
struct TetWork
{
  double elastic = 0.0, kinetic = 0.0;                             ///< [J]
  double damping_power_mass = 0.0, damping_power_stiffness = 0.0;  ///< [W]
};

/// Tets that are turned inside out, in file numbering: the first of linear tissue, which feels
/// nothing of it, and the first of other tissue; -1: none.
struct Folded
{
  int linear = -1, other = -1;
};

/// The sums over the tets of a rank: forces, operator, energies, stress. Linear or quadratic tets,
/// any model. Borrows mesh and space. Nothing here is collective.
class Elements
{
 public:
  static std::unique_ptr<Elements> make(const mesh::Mesh& mesh, const fem::Space& space,
                                        const ElementSettings& settings);
  virtual ~Elements() = default;

  /// Nodes that a shared dilatation couples, beyond those of the tets.
  virtual const fem::Cliques& cliques() const = 0;

  /// The first tets that are turned inside out at u.
  virtual Folded folded(const GhostedField& u) const = 0;
  /// Rotations, and for exact tangents the rest, at u. False when a tet is turned inside out.
  virtual bool configure(const GhostedField& u, LinearisationPoint& at) const = 0;
  /// Pressures [Pa] to which the linearisation `last` leads with the further displacement d: what
  /// Newton's method has for them when they are unknowns of their own. In the tangent they serve
  /// better than λθ, which after a finite step is λ times the square of the strain off.
  virtual core::VecX linearised_pressures(const LinearisationPoint& last,
                                          const GhostedField& d) const = 0;
  /// As far as the forces of some tets need it.
  virtual void configure_for(const std::vector<std::size_t>& tets, const GhostedField& u,
                             LinearisationPoint& at) const = 0;

  /// Adds K + β r_v K_v + (r_a + α) r_v M [N/m] with the rates r_v, r_a of velocity and
  /// acceleration; K_v is that of the viscous stress, K itself where K is R K₀ Rᵀ.
  virtual void assemble(const LinearisationPoint& at, const core::Rates& rate,
                        const fem::BlockPattern& pattern, fem::BlockMatrix& values) const = 0;
  /// The same operator times d [N], without its matrix and its supports.
  virtual OwnedField operate(const LinearisationPoint& at, const core::Rates& rate,
                             const GhostedField& d) const = 0;

  /// Adds the forces of stress, stiffness damping, and inertia with mass damping.
  virtual void add_forces(const LinearisationPoint& at, const Kinematics& motion,
                          ForceSums& sums) const = 0;
  /// The same into the nodes of some tets only.
  virtual void add_forces_of(const std::vector<std::size_t>& tets, const LinearisationPoint& at,
                             const Kinematics& motion, ForceSums& sums) const = 0;
  /// Adds the forces of inertia with mass damping alone [N].
  virtual void add_inertia(const Kinematics& motion, OwnedField& inertia) const = 0;
  /// Takes the exact tangent, or that with the rotations held, from the next `configure` on.
  virtual void take(Tangent tangent) = 0;

  virtual TetWork work(const LinearisationPoint& at, const Kinematics& motion) const = 0;
  /// By local tet.
  virtual StressField stresses(const LinearisationPoint& at, const GhostedField& u) const = 0;

  /// Adds ρ V N_a g to the nodes [N].
  virtual void add_weight(const core::Vec3& gravity, OwnedField& force) const = 0;
  /// Volume-weighted sum of the turns R R₀ᵀ around every local node [m³]; identities at nodes that
  /// linear tissue has a part in, which does not turn.
  virtual std::vector<Mat3> turns(const std::vector<Mat3>& R,
                                  const std::vector<Mat3>& R_old) const = 0;
};

}  // namespace trocar::tissue
