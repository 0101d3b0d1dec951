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
  double density = 0.0;  ///< [kg/m³]; 0: neither weight nor inertia
  int elements = 20;
  double bevel = 0.0;           ///< see Shaft::bevel
  Vec3 gravity = Vec3::Zero();  ///< [m/s²]
};

/// Shape and velocity of a needle. A value type, equal on every rank.
struct NeedleState
{
  Shaft shaft;
  std::vector<Vec3> v;  ///< nodal velocity [m/s]
  std::vector<Vec3> w;  ///< nodal angular velocity [rad/s]
  double travel = 0.0;  ///< advance of the base along its own axis since the start [m]

  bool finite() const;

  /// Names every member and its unit, see core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("shaft", "", self.shaft);
    v("velocity", "m/s", self.v);
    v("angular_velocity", "rad/s", self.w);
    v("travel", "m", self.travel);
  }
};

/// Equations of a needle linearised about a shape: A d = r - H_nᵀλ + forces of the holder, with the
/// increment d of 6 dofs per node (δx, δθ). The first `held` dofs follow the prescribed motion of
/// the base: d = 0 there.
struct Linearised
{
  int held = 6;           ///< number of held dofs: 6 for a beam, all for a rigid needle
  MatX A;                 ///< M/(h h̄) + K (dofs x dofs) [N/m, N, N m]
  VecX r;                 ///< weight - internal - inertia forces (dofs) [N, N m]
  core::Cholesky factor;  ///< of A on the free dofs; empty for a rigid needle
  VecX free_increment;    ///< A⁻¹ r on the free dofs [m, rad]
};

/// Elastic and kinetic energy of a needle at the end of a step, and the work of its weight in the
/// step [J].
struct Energy
{
  double elastic = 0.0, kinetic = 0.0, weight = 0.0;
};

/// Force and moment of the holder on the needle, in world axes. The moment is about the base.
struct Wrench
{
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< [N m]
};

/// One needle, straight at rest and clamped at its moving base. It is a corotational Timoshenko
/// beam or rigid. Not collective: every rank holds and solves the whole needle, which is small.
class Needle
{
 public:
  explicit Needle(NeedleSettings settings);

  const NeedleSettings& settings() const { return settings_; }
  int dofs() const { return 6 * (settings_.elements + 1); }

  NeedleState initial() const;
  /// First iterate of a step: the old shape, moved rigidly with the base to its pose at time t.
  /// The tip of this shape is the tip that cuts. `travel` already has its value at the end of the
  /// step.
  NeedleState predict(const NeedleState& old, double t) const;
  Linearised linearise(const NeedleState& old, const NeedleState& iterate,
                       const core::TimeStep& step) const;
  /// `iterate` plus the increment d under λ, with the velocities that follow. `coupling`: H_nᵀλ on
  /// all dofs [N, N m].
  NeedleState correct(const NeedleState& old, const NeedleState& iterate, const Linearised& linear,
                      const VecX& coupling, const core::TimeStep& step) const;
  /// Weight minus internal and inertia forces at the shape `at` [N, N m]: `Linearised::r`, but
  /// without the cost of tangent and factor.
  VecX residual(const NeedleState& old, const NeedleState& at, const core::TimeStep& step) const;
  /// Largest entry of the increment d under `coupling`: displacements over the needle's length,
  /// rotations in rad. It is small when the iteration has converged.
  double relative_increment(const Linearised& linear, const VecX& coupling) const;
  /// Force and moment of the holder, from the linearised equations that `correct` solves:
  /// A d - r + H_nᵀλ on the held dofs.
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
