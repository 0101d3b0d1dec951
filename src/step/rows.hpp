#pragma once

#include "step/model.hpp"
#include "step/report.hpp"
#include "step/scheme.hpp"

namespace trocar::step {

/// The rows of one linearisation, before they are a system.
struct Rows
{
  constraint::Set set;
  std::vector<insertion::CouplingRows> of_needle;  ///< empty where no needle touches tissue
};

/// Rows of the needles where the state has them. Collective.
Rows coupling_rows(const Model& model, const core::TimeStep& now, const State& state);

/// One linearisation of all bodies, solved: A Δu = r + Hᵀλ with λ in the laws.
struct Solution
{
  std::vector<needle::Linearised> needles;
  constraint::System system;
  std::vector<insertion::CouplingRows> of_needle;
  cavity::CavityRows of_cavities;
  constraint::Saddle saddle{};
  core::VecX mobility{};  ///< of the rows, see law::mobility [m/N]

  const core::VecX& lambda() const { return saddle.multipliers.lambda; }
  /// Hᵀλ of the rows that are not cavities [N].
  fem::OwnedField needle_forces(const fem::Space& space) const;
  /// Forces of needles and cavities on the tissue where the state has it [N].
  fem::OwnedField forces(const Model& model, const State& state, const cavity::Shape& walls,
                         const core::TimeStep& now) const;
  /// H_nᵀλ on all dofs of a needle [N, N m].
  core::VecX on_needle(std::size_t i) const
  {
    return system.body_forces(lambda(), static_cast<int>(i));
  }
};

/// The gaps of the rows that hold needles across, `here` in the geometry that the solution led to,
/// are closed: rows turn with the shaft. Not collective.
bool gaps_closed(const Model& model, const Solution& solution, const Rows& here);

/// What another linearisation would change of the forces that beams are held with, as a part of the
/// largest of each, 0 to 1. `here`: the rows at `state`. Not collective.
double left_across(const Model& model, const Scheme& scheme, const State& state,
                   const Solution& solution, const Rows& here);

}  // namespace trocar::step
