#pragma once

#include <functional>

#include "solve/isolated_compliance.hpp"

namespace trocar::tissue {

/// What the rows of a pass did to the tissue, as an approach with an older factor needs it.
struct Push
{
  core::VecX lambda;  ///< multipliers (rows) [N]
  /// Nodal forces Hᵀλ [N] of multipliers. Collective.
  std::function<fem::OwnedField(const core::VecX&)> forces;
  /// λᵀ(H_n A_n⁻¹ H_nᵀ + c) µ [J]: what else gives way to the rows, needles and soft rows.
  std::function<double(const core::VecX&, const core::VecX&)> yielding;
  bool same_laws = false;  ///< rows hold and slip as in the pass before, and no bound follows a row
};

/// The way to  A Δu = r + Hᵀλ, (δ, λ) in the laws  when the factor is not that of A but of P: of
/// an older operator, or without the stiffness of loads that follow the tissue. It is by conjugate
/// gradients on the held rows, the pass of a step (one sweep with P, then the laws with
/// P's compliance) as their preconditioner. As long as rows change between holding and slipping it
/// is the plain iteration u <- u + P⁻¹(rest).
struct Approach
{
  fem::OwnedField u;                       ///< where the next pass starts [m]
  core::VecX lambda;                       ///< multipliers there (rows) [N]
  fem::OwnedField residual;                ///< r + Hᵀλ - A Δu there [N]
  fem::OwnedField direction, A_direction;  ///< last direction [m] and its product with A [N]
  core::VecX lambda_direction;
  double direction_energy = 0.0;  ///< of the last direction [J]; 0: none
  double load = 0.0;              ///< ‖r‖ [N]
  double least = 0.0;             ///< what need not be balanced any further [N]
  /// ∂f/∂u of loads that follow, part of -A; empty: none.
  std::function<fem::OwnedField(const fem::OwnedField&)> stiffness;
  bool on_rows = false;  ///< u meets the laws of all rows with `lambda`
  int passes = 0;
};

}  // namespace trocar::tissue
