#pragma once

#include "fem/space.hpp"

namespace trocar::tissue {

/// How far a state is from equilibrium (docs/theory.md section 1). The residual r_a of node a is
/// compared with the forces that meet at this node, not with those of the stiffest part of the
/// body.
struct Balance
{
  /// Progress measure of the iteration: ‖r‖ / (‖f_ext‖ + ‖f_int‖ + ‖inertia‖ + ‖Hᵀλ‖ + `rounded`
  /// over the Newton tolerance). The norms are those of assembled nodal forces.
  double norm = 0.0;
  /// Largest |r_a| over the scale of its node, Σ_e |f_e,a| + |f_ext,a| + |(Hᵀλ)_a| + two floors
  /// (see `of_largest`). f_e,a is the internal and inertial force of tet e at the node.
  double worst = 0.0;
  double lost = 0.0;  ///< |Σ r_a|: part of the loads that the supports do not carry [N]
  /// The larger of two sums of |force|: over loads, rows and fluids, and over supports [N].
  double carried = 0.0;
  double rounded = 0.0;  ///< norm of the bounds on the rounding errors of nodal forces [N]

  /// Whether the supports carry the loads to a tolerance. Rounding errors of the nodes nearly
  /// cancel in the sum Σ r_a, hence the factor 0.01.
  bool carries(double tolerance) const { return lost <= tolerance * carried + 0.01 * rounded; }

  /// First floor of a node's scale: this part of the largest scale of all nodes. It loosens the
  /// test for nodes far from all loads. Second floor: the bound on the rounding error over the
  /// Newton tolerance, because no node can be balanced better than rounding allows. The actual
  /// errors are 10 to 100 times smaller than this bound.
  static constexpr double of_largest = 1e-4;
};

/// Magnitudes of the forces whose sum is a residual.
struct Sizes
{
  core::VecX size, rounding;   ///< as in ForceSums; `size` includes the loads (owned nodes) [N]
  double norms = 0.0;          ///< ‖f_ext‖ + ‖f_int‖ + ‖inertia‖ [N]
  fem::OwnedField internal{};  ///< forces of stress and stiffness damping [N]
  fem::OwnedField damping{};   ///< as in ForceSums; empty: no stiffness damping [N]
};

}  // namespace trocar::tissue
