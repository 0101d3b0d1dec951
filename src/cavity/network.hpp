#pragma once

#include <vector>

#include "cavity/cavities.hpp"

// The fluids of cavities and the conduits between them. Not collective where nothing is said.
namespace trocar::cavity {

/// Volume and compliance of the fluids at given pressures, the network over a step included.
struct Fluid
{
  VecX volume;      ///< V_law(p) (cavities) [m³]
  MatX compliance;  ///< D = -∂V_law/∂p, symmetric positive semidefinite [m³/Pa]
  VecX round_off;   ///< of the volume: flows are differences of pressures (cavities) [m³]
};

Fluid fluid(const Cavities& cavities, const State& state, const VecX& p, const TimeStep& now);

/// A cavity whose fluid has flowed out whole, of which more than nothing is wanted; -1: none.
int drained(const Fluid& fluid);

State start(const Cavities& cavities);

/// What lies between two states: time, and the needles' stretches in voids.
struct Between
{
  double t_old, t;                            ///< [s]
  std::vector<std::vector<VoidPiece>> voids;  ///< by needle
};
/// Decides before the solve what needles have opened and what curves inject in the step. `u`:
/// displacement at the start of the step. Collective.
State advance(const Cavities& cavities, const State& old, const Between& step, const OwnedField& u);

/// True when every exact volume is that of its fluid, to its tolerance.
bool closed(const Cavities& cavities, const State& state, const Shape& shape, const TimeStep& now);

/// The tissue and its walls at a time.
struct Configuration
{
  const OwnedField& u;  ///< displacement [m]
  const Shape& shape;   ///< of the walls at u
  const TimeStep& now;
};
/// Ends a step there: books flows and amounts in the state, and reports on every cavity.
/// Collective.
std::vector<CavityReport> accept(const Cavities& cavities, const Configuration& end, State& state);

/// V_0 + g_0·u of a linear cavity [m³]. Collective.
double linear_volume(const Cavities& cavities, int i, const OwnedField& u);

/// For P-V curves: the cavity holds this volume, whatever its law.
void hold_volume(int cavity, double volume, State& state);

}  // namespace trocar::cavity
