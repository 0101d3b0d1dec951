#pragma once

#include <vector>

#include "cavity/cavities.hpp"

// The fluids of cavities and the conduits between them. Not collective unless a comment says so.
namespace trocar::cavity {

/// Volume and compliance of the fluids at given pressures, with the flows of a step through
/// conduits.
struct Fluid
{
  VecX volume;      ///< V_law(p) (cavities) [m³]
  MatX compliance;  ///< D = -∂V_law/∂p, symmetric positive semidefinite [m³/Pa]
  VecX round_off;   ///< of `volume`, from differences of pressures in flows (cavities) [m³]
};

Fluid fluid(const Cavities& cavities, const State& state, const VecX& p, const TimeStep& now);

/// First cavity with V_law < 0 and D < 0: more fluid flows out of it than it holds. -1: none.
int drained(const Fluid& fluid);

State start(const Cavities& cavities);

/// What changes from one state to the next: the time, and the needles' stretches in voids.
struct Between
{
  double t_old, t;                            ///< times of the two states [s]
  std::vector<std::vector<VoidPiece>> voids;  ///< by needle
};
/// Decides before the solve which conduits needles have opened, and adds the fluid that curves
/// inject in the step. `u`: displacement at the start of the step. Collective.
State advance(const Cavities& cavities, const State& old, const Between& step, const OwnedField& u);

/// True when V = V_law to tolerance in all frozen and follower cavities without given pressure.
bool closed(const Cavities& cavities, const State& state, const Shape& shape, const TimeStep& now);

/// The tissue and its walls at a time.
struct Configuration
{
  const OwnedField& u;  ///< displacement [m]
  const Shape& shape;   ///< of the walls at u
  const TimeStep& now;
};
/// Ends a step at this configuration: updates flows and amounts in `state`, and reports on every
/// cavity. Collective.
std::vector<CavityReport> accept(const Cavities& cavities, const Configuration& end, State& state);

/// V_0 + g_0·u of a linear cavity [m³]. Collective.
double linear_volume(const Cavities& cavities, int i, const OwnedField& u);

/// For P-V curves: makes the cavity's fluid hold this volume [m³], whatever its law.
void hold_volume(int cavity, double volume, State& state);

}  // namespace trocar::cavity
