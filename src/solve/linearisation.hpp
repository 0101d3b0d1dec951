#pragma once

#include <functional>
#include <optional>

#include "solve/lagged_factor.hpp"

namespace trocar::solve {

/// The tissue's equations linearised at one displacement:  A Δu = r + Hᵀλ,  with Δu counted from
/// `base`. `factor` may be lagged: the factor of an older operator, or one without the
/// stiffness of loads that follow the tissue.
struct Linearisation
{
  OwnedField iterate;   ///< displacement where equations and gaps of rows are evaluated [m]
  OwnedField base;      ///< `iterate` with the prescribed displacements of the step's end [m]
  OwnedField residual;  ///< r, zero on fixed dofs [N]
  std::optional<OwnedField> guess{};  ///< first Δu of iterations: h times velocity [m]
  double least = 0.0;         ///< residual norm at rounding level; iterations stop there [N]
  bool loads_follow = false;  ///< loads follow the tissue, so A may be indefinite
  /// Product A d [N] for d [m]. Collective.
  std::function<OwnedField(const OwnedField&)> product{};
  LaggedFactor* factor = nullptr;
  /// Factors A anew, without the stiffness of loads that follow the tissue. Collective.
  std::function<Outcome<Done>()> refactor{};
  std::optional<HalfSolution> half{};  ///< forward half of A⁻¹ r, once `forward` was called

  /// True when the factor is not that of A.
  bool lagged() const { return factor->lags() || loads_follow; }
  const fem::Space& space() const { return factor->space(); }
  /// Forward half of A⁻¹ r with the present factor, computed once. Collective.
  const HalfSolution& forward()
  {
    if (!half) half = factor->begin(residual);
    return *half;
  }
  /// Solution without rows, base + A⁻¹ r [m]. Needs a factor that is not lagged. Collective.
  OwnedField alone() { return {base.value + factor->finish(forward(), {}, {}).value}; }
};

/// Runs `work` and returns its outcome. Where a linear solver misses its tolerance (`Unsolved`),
/// returns a refusal with the solver's message. Collective.
template <class Work>
auto attempted(const Work& work) -> decltype(work())
{
  try {
    return work();
  } catch (const core::Unsolved& failure) {
    return core::Refusal{failure.what(), true};
  }
}

}  // namespace trocar::solve
