#pragma once

#include "constraint/laws.hpp"
#include "solve/linearisation.hpp"

namespace trocar::constraint {

/// Solution of a linearisation with its rows in their laws.
struct Saddle
{
  solve::OwnedField u;             ///< displacement base + Δu [m]
  law::Multipliers multipliers{};  ///< of the rows; empty without rows
  law::Problem problem{};          ///< the dense problem that the multipliers solve
};

/// How `solve_saddle` proceeds where the factor is not that of A.
struct SaddleSettings
{
  bool stale = false;        ///< use `paper` instead of `projected_cg`
  bool stale_error = false;  ///< use `projected_cg` too, to report the error of `paper`
  double tolerance = 1e-8;  ///< of projected_cg: ‖r + Hᵀλ - AΔu‖ over ‖r‖ + ‖Hᵀλ‖
};

/// Solves  A Δu = r + Hᵀλ, (δ, λ) in the laws of the rows.  With the factor of A one pass is
/// enough (`direct`). An older factor, or loads that follow, need conjugate gradients
/// (`projected_cg`) or the needle paper's approximation (`paper`). `start`: multipliers to start
/// from [N]. Collective.
Outcome<Saddle> solve_saddle(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                             const SaddleSettings& settings);

Outcome<Saddle> direct(Laws& laws, solve::Linearisation& at, const core::VecX& start);

/// Projected conjugate gradients on the held rows (Gould, Hribar and Nocedal 2001). Their
/// constraint preconditioner is one pass: a sweep with the old factor, and the laws with its
/// compliance. As long as rows change between holding and slipping, damped steps along the
/// preconditioned residual take the place of conjugate ones. Where the passes with an old
/// factor do not converge, a new factor is made.
Outcome<Saddle> projected_cg(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                             double tolerance);

/// The needle paper's reuse of columns from step to step: the laws are met once, with the
/// compliance of an older operator, and the tissue obeys the present operator. The resulting error
/// of the gaps is reported (`LawReport::leftover_gap`).
Outcome<Saddle> paper(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                      const SaddleSettings& settings);

}  // namespace trocar::constraint
