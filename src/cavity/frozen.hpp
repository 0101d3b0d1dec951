#pragma once

#include <vector>

#include "cavity/network.hpp"
#include "core/outcome.hpp"

// Pressures of frozen cavities. The load does not follow the wall, but the volume is that of the
// deformed wall. No symmetric row can express both, so the pressures are sought outside the
// constraint system, as in the fluid paper.
namespace trocar::cavity {

/// Responses of tissue and rows to the pressures of frozen cavities.
struct PressureResponses
{
  std::vector<OwnedField> per_p;  ///< displacement per unit pressure, by frozen cavity [m/Pa]
  VecX gain;                      ///< K_p of the proportional solver, by frozen cavity [Pa]
};

/// Cavities of the frozen model whose pressure is not given.
std::vector<int> frozen(const Cavities& cavities, const State& state);

/// Next pressures of the frozen cavities [Pa], with the walls at `shape`. Refused when no pressure
/// gives a fluid's volume, or when a volume does not grow with its pressure. Collective.
core::Outcome<VecX> next_pressures(const Cavities& cavities, const State& state, const Shape& shape,
                                   const PressureResponses& answers, const TimeStep& now);
void set_pressures(const std::vector<int>& which, const VecX& p, State& state);

int most_updates(const Cavities& cavities);   ///< most updates of the pressures in one search
bool proportional(const Cavities& cavities);  ///< true: frozen cavities use that solver

/// Slope dp/d(V/V_0) [Pa] of the least-squares line through p(V) between 0.7 and 1.3 V_0. `per_p`:
/// displacement per unit pressure of the undeformed tissue [m/Pa]. Throws Failure (70) when the
/// slope is not positive. Collective.
double line_gain(const Cavities& cavities, int cavity, const OwnedField& per_p);

}  // namespace trocar::cavity
