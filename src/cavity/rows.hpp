#pragma once

#include <vector>

#include "cavity/network.hpp"
#include "constraint/set.hpp"

// Rows of cavities in the constraint system: the multiplier is p·area [N] and the gap is
// (V - V_law)/area [m].
namespace trocar::cavity {

/// Rows of cavities in a set: row `first + k` is that of cavity `cavity[k]`.
struct CavityRows
{
  int first = 0;
  std::vector<int> cavity;
  VecX held;      ///< volume of the wall at zero increments, by row [m³]
  VecX pressure;  ///< where the fluids are linearised, by cavity [Pa]
  Fluid fluid;    ///< the fluids at `pressure`
  State state;    ///< of the cavities, for `refresh`
  TimeStep now;
};

/// Adds rows for linear and follower cavities without given pressure, at an iterate. Collective.
CavityRows add_rows(Cavities& cavities, const State& state, const Configuration& at,
                    constraint::Set& set);

/// Linearises the fluids anew at the pressures of λ and updates the rows. False, and nothing
/// changed, when the last linearisation gives the volumes at λ to 1e-13 V_0.
bool refresh(const Cavities& cavities, const VecX& lambda, CavityRows& rows, constraint::Set& set);

/// Sets the pressures in `state`: of rows from their multipliers, given ones from the time.
void take_pressures(const Cavities& cavities, const CavityRows& rows, const VecX& lambda,
                    const TimeStep& now, State& state);

}  // namespace trocar::cavity
