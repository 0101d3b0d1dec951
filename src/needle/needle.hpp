#pragma once

#include <string>
#include <vector>

#include "core/dense.hpp"
#include "core/time_step.hpp"
#include "needle/beam_element.hpp"
#include "needle/motion.hpp"
#include "needle/shaft.hpp"

namespace trocar::needle {

using core::MatX;
using core::VecX;

enum class Model { rigid, beam };

struct NeedleSettings
{
  std::string name;
  Model model = Model::beam;
  BaseMotion motion;
  Section section;
  double density = 0.0;  ///< [kg/m³], 0: neither weight nor inertia
  int elements = 20;
  double bevel = 0.0;           ///< see Shaft::bevel
  Vec3 gravity = Vec3::Zero();  ///< [m/s²]
};

/// Shape and velocity of a needle. A value, equal on every rank.
struct NeedleState
{
  Shaft shaft;
  std::vector<Vec3> v;  ///< nodal velocity [m/s]
  std::vector<Vec3> w;  ///< nodal angular velocity [rad/s]
  double travel = 0.0;  ///< advance of the base along its own axis since the start [m]

  bool finite() const;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("shaft", "", self.shaft);
    v("velocity", "m/s", self.v);
    v("angular_velocity", "rad/s", self.w);
    v("travel", "m", self.travel);
  }
};

/// A needle linearised about a shape: A d = r - H_nᵀλ + holder, on 6 dofs per node (δx, δθ).
/// The base (first `held` dofs) follows the prescribed motion.
struct Linearised
{
  int held = 6;           ///< 6 for a beam, all dofs for a rigid needle
  MatX A;                 ///< M/(h h̄) + K (dofs x dofs) [N/m ...]
  VecX r;                 ///< weight - internal - inertia forces (dofs) [N, N m]
  core::Cholesky factor;  ///< of A on the free dofs, when there are any
  VecX free_increment;    ///< A⁻¹ r on the free dofs
};

/// Energies of a needle, and the work of its weight from one state to the next [J].
struct Energy
{
  double elastic = 0.0, kinetic = 0.0, weight = 0.0;
};

/// What the holder puts on the needle at its base, world axes, moment about the base.
struct Wrench
{
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< [N m]
};

/// One needle: straight at rest, clamped to its moving base. Corotational Timoshenko beam or
/// rigid. Not collective: small enough for every rank to hold and solve whole.
class Needle
{
 public:
  explicit Needle(NeedleSettings settings);

  const NeedleSettings& settings() const { return settings_; }
  int dofs() const { return 6 * (settings_.elements + 1); }

  NeedleState initial() const;
  /// The old shape carried rigidly to the base pose at time t: where a step starts to iterate.
  /// Its tip is the tip that cuts; its travel is that of the step's end.
  NeedleState predict(const NeedleState& old, double t) const;
  Linearised linearise(const NeedleState& old, const NeedleState& iterate,
                       const core::TimeStep& step) const;
  /// Adds the increment of λ: `coupling` is H_nᵀλ on all dofs.
  NeedleState correct(const NeedleState& old, const NeedleState& iterate, const Linearised& linear,
                      const VecX& coupling, const core::TimeStep& step) const;
  /// Weight less internal and inertia forces at a shape, `Linearised::r` without the rest.
  VecX residual(const NeedleState& old, const NeedleState& at, const core::TimeStep& step) const;
  /// Size of the increment that λ leaves to be made, rotations times the length, over the length.
  double relative_increment(const Linearised& linear, const VecX& coupling) const;
  /// The holder's wrench in the linearised balance that `correct` satisfies.
  Wrench base_wrench(const NeedleState& iterate, const Linearised& linear,
                     const VecX& coupling) const;

  Energy energy(const NeedleState& old, const NeedleState& next) const;

 private:
  VecX weight_and_inertia(const NeedleState& old, const NeedleState& at,
                          const core::TimeStep& step) const;
  VecX increment(const Linearised& linear, const VecX& coupling) const;
  Mat3 rotary_inertia(int node, const Mat3& R) const;
  double nodal_mass(int node) const;
  Shaft straight(const Pose& base) const;

  NeedleSettings settings_;
  Mat12 element_stiffness_;
};

}  // namespace trocar::needle
