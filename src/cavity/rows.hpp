#pragma once

#include <vector>

#include "cavity/network.hpp"
#include "constraint/set.hpp"

// Cavities in the constraint system: a row has the multiplier p·area [N] and the gap
// (V - V_law)/area [m].
namespace trocar::cavity {

/// Rows of cavities in a set: row `first + k` is that of cavity `cavity[k]`.
struct CavityRows
{
  int first = 0;
  std::vector<int> cavity;
  VecX held;      ///< volume at zero increments, by row [m³]
  VecX pressure;  ///< at which the fluids were linearised, by cavity [Pa]
  Fluid fluid;    ///< there
  State state;    ///< that the fluids were linearised for
  TimeStep now;
};

/// Rows of linear and follower cavities at the end of the last iterate. Collective.
CavityRows add_rows(Cavities& cavities, const State& state, const Configuration& at,
                    constraint::Set& set);

/// Linearises the fluids anew where the multipliers have led; false when they were right.
bool refresh(const Cavities& cavities, const VecX& lambda, CavityRows& rows, constraint::Set& set);

/// Pressures from multipliers, and given ones of this time.
void take_pressures(const Cavities& cavities, const CavityRows& rows, const VecX& lambda,
                    const TimeStep& now, State& state);

}  // namespace trocar::cavity
