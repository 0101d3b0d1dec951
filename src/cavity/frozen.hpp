#pragma once

#include <vector>

#include "cavity/network.hpp"
#include "core/outcome.hpp"

// Pressures of frozen cavities: the load does not follow the wall but the volume is exact, so that
// the pressure is sought outside the (symmetric) constraint system, as in the fluid paper.
namespace trocar::cavity {

/// How tissue and rows answer to the pressures of frozen cavities.
struct PressureResponses
{
  std::vector<OwnedField> per_p;  ///< displacement per unit of every one [m/Pa]
  VecX gain;                      ///< K_p of the proportional solver [Pa]
};

/// Cavities of the frozen model whose pressure is not given.
std::vector<int> frozen(const Cavities& cavities, const State& state);

/// Next pressures of the frozen cavities from where the walls are [Pa]; refused where there are
/// none. Collective.
core::Outcome<VecX> next_pressures(const Cavities& cavities, const State& state, const Shape& shape,
                                   const PressureResponses& answers, const TimeStep& now);
void set_pressures(const std::vector<int>& which, const VecX& p, State& state);

int most_updates(const Cavities& cavities);   ///< of pressures in one step
bool proportional(const Cavities& cavities);  ///< the solver of the frozen cavities

/// Slope dP/d(V/V_0) of the line through V(p) between 0.7 and 1.3 V_0 [Pa]; `per_p`: displacement
/// per unit pressure, everything else at rest. Collective.
double line_gain(const Cavities& cavities, int cavity, const OwnedField& per_p);

}  // namespace trocar::cavity
