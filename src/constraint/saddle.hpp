#pragma once

#include "constraint/laws.hpp"
#include "solve/linearisation.hpp"

namespace trocar::constraint {

/// Where a linearisation leads with its rows in their laws.
struct Saddle
{
  solve::OwnedField u;             ///< the place: base + Δu [m]
  law::Multipliers multipliers{};  ///< of the rows; empty without rows
  law::Problem problem{};          ///< that they solve
};

/// Which of the three ways is taken where the factor lags.
struct SaddleSettings
{
  bool stale = false;        ///< the paper's way: laws once, with the compliance of the old factor
  bool stale_error = false;  ///< and the exact way beside it, to tell how far off that is
  double tolerance = 1e-8;  ///< ‖r + Hᵀλ - AΔu‖ of ‖r‖ + ‖Hᵀλ‖ where it is iterated
};

/// Solves  A Δu = r + Hᵀλ, (δ, λ) in the laws of the rows  and moves to there. With the factor of A
/// by one sweep (`direct`); with an older one, or under loads that follow, by conjugate gradients
/// (`projected_cg`), or as the needle paper does (`paper`). `start`: multipliers to begin with.
/// Collective.
Outcome<Saddle> solve_saddle(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                             const SaddleSettings& settings);

Outcome<Saddle> direct(Laws& laws, solve::Linearisation& at, const core::VecX& start);

/// Conjugate gradients on the held rows, one sweep with the old factor and the laws with its
/// compliance as their preconditioner: constraint-preconditioned, projected CG. As long as rows
/// change between holding and slipping it is the plain iteration u <- u + P⁻¹(rest). A factor that
/// does not lead on is made anew.
Outcome<Saddle> projected_cg(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                             double tolerance);

/// The needle paper's reuse of columns from step to step: the laws are met once, with the
/// compliance of an older operator; the tissue obeys the present one. What the gaps are off is
/// reported.
Outcome<Saddle> paper(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                      const SaddleSettings& settings);

}  // namespace trocar::constraint
