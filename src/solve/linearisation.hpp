#pragma once

#include <functional>
#include <optional>

#include "solve/lagged_factor.hpp"

namespace trocar::solve {

/// The tissue's equations about one place,  A Δu = r + Hᵀλ  for the way Δu from `base`, with a
/// factor to solve them by: of A itself, or of an older operator or without the stiffness of loads
/// that follow the tissue.
struct Linearisation
{
  OwnedField iterate;                 ///< the place; gaps of rows are measured from there [m]
  OwnedField base;                    ///< the same with prescribed displacements [m]
  OwnedField residual;                ///< r, zero on fixed dofs [N]
  std::optional<OwnedField> guess{};  ///< a first Δu for iterations: where the velocity leads [m]
  double least = 0.0;                 ///< norm of a rest that need not be balanced any further [N]
  bool loads_follow = false;          ///< A is not positive definite for certain
  /// A d [N]. Collective.
  std::function<OwnedField(const OwnedField&)> product{};
  LaggedFactor* factor = nullptr;
  /// Makes the factor of A as far as it is the tissue's. Collective.
  std::function<Outcome<Done>()> refactor{};
  std::optional<HalfSolution> half{};  ///< of A⁻¹ r, once it was asked for

  /// The factor is not that of A.
  bool lagged() const { return factor->lags() || loads_follow; }
  const fem::Space& space() const { return factor->space(); }
  /// A⁻¹ r on its way, with the factor as it is. Collective.
  const HalfSolution& forward()
  {
    if (!half) half = factor->begin(residual);
    return *half;
  }
  /// The place without rows, where the factor is that of A. Collective.
  OwnedField alone() { return {base.value + factor->finish(forward(), {}, {}).value}; }
};

/// What a linear solver says when it stops short (`Unsolved`) as an outcome. Collective.
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
