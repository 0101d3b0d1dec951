#pragma once

#include "step/model.hpp"
#include "step/report.hpp"
#include "step/scheme.hpp"

namespace trocar::step {

/// The rows of one linearisation, from which a constraint::System is made.
struct Rows
{
  constraint::Set set;
  std::vector<insertion::CouplingRows> of_needle;  ///< empty when no needle touches tissue
};

/// Rows of the needles, evaluated at `state`. Collective.
Rows coupling_rows(const Model& model, const core::TimeStep& now, const State& state);

/// Solution of one linearisation of all bodies: A Δu = r + Hᵀλ with λ in the laws of the rows.
struct Solution
{
  std::vector<needle::Linearised> needles;
  constraint::System system;
  std::vector<insertion::CouplingRows> of_needle;
  cavity::CavityRows of_cavities;
  contact::Rows of_contact{};
  std::optional<contact::Ending> contact{};  ///< at the end; nothing: no pair is near
  constraint::Saddle saddle{};
  core::VecX mobility{};  ///< of the rows, see law::mobility [m/N]

  const core::VecX& lambda() const { return saddle.multipliers.lambda; }
  /// Hᵀλ of the needles' rows [N].
  fem::OwnedField needle_forces(const fem::Space& space) const;
  /// Forces of needles, contact and cavities on the tissue at `state` [N]. `walls`: the cavity
  /// walls there.
  fem::OwnedField forces(const Model& model, const State& state, const cavity::Shape& walls,
                         const core::TimeStep& now) const;
  /// H_nᵀλ on all dofs of needle i [N, N m]; the needle feels the negative.
  core::VecX on_needle(std::size_t i) const
  {
    return system.body_forces(lambda(), static_cast<int>(i));
  }
};

/// True when the gaps of all lateral rows are closed, except rows with a compliance and rows that
/// nothing can move. `here`: the rows at the shape that the solution led to. Their gaps are not
/// those of the solution, because rows turn with the shaft. Not collective.
bool gaps_closed(const Model& model, const Solution& solution, const Rows& here);

/// Residual up to which the laws of contact hold in the geometry at the end [m].
double contact_tolerance(const Model& model);

/// How much another linearisation would change the lateral forces on the beams, 0 to 1: the largest
/// max f / (max |λ| + max f) of all beams, where f are the changes of the forces (docs/theory.md
/// section 1). `here`: the rows at `state`. Not collective.
double left_across(const Model& model, const Scheme& scheme, const State& state,
                   const Solution& solution, const Rows& here);

}  // namespace trocar::step
