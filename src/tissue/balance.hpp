#pragma once

#include "fem/space.hpp"

namespace trocar::tissue {

/// How far a state is from equilibrium. What is out of balance at a node is judged by the forces
/// that meet there, not by those of the stiffest part of the body.
struct Balance
{
  /// ‖r‖ over ‖f_ext‖ + ‖f_int‖ + ‖inertia‖ + ‖Hᵀλ‖, each summed up at the nodes: how far the
  /// iteration has come.
  double norm = 0.0;
  /// The largest |r_a| over its scale  Σ_e |f_e| + |f_ext| + |Hᵀλ|  (internal and inertial forces
  /// of the tets at the node), with the floors below.
  double worst = 0.0;
  double lost = 0.0;     ///< |Σ r_a|: what the supports do not carry of the loads [N]
  double carried = 0.0;  ///< Σ |forces| of loads, rows and fluids, or of the supports [N]
  double rounded = 0.0;  ///< norm of what rounding may make of nodal forces [N]

  /// Whether supports carry the loads to a tolerance. In their sum rounding nearly cancels.
  bool carries(double tolerance) const { return lost <= tolerance * carried + 0.01 * rounded; }

  /// Floors of a node's scale. Far from all loads a node need not be balanced better than this part
  /// of the largest scale;
  static constexpr double of_largest = 1e-4;
  /// and nowhere better than rounding lets it: its bound over the tolerance is part of the scale.
  /// What comes of rounding is 10 to 100 times less than the bound.
};

/// What a residual is made of.
struct Sizes
{
  core::VecX size, rounding;   ///< see ForceSums, loads included (owned nodes) [N]
  double norms = 0.0;          ///< ‖f_ext‖ + ‖f_int‖ + ‖inertia‖ [N]
  fem::OwnedField internal{};  ///< forces of stress and stiffness damping [N]
  fem::OwnedField damping{};   ///< of stiffness damping alone; empty: there is none [N]
};

}  // namespace trocar::tissue
