#include <cmath>

#include "driver/simulation.hpp"

// Increments of Newton's method that are too long.
namespace trocar::driver {

/// ‖r‖ over the forces it is the rest of, with these forces on the tissue.
double Simulation::unbalanced(const State& past, const fem::OwnedField& u,
                              const core::TimeStep& now, const fem::OwnedField& forces) const
{
  double scale = 0.0;
  fem::OwnedField r = tissue_.residual(past.tissue, u, now, scale);
  fem::OwnedField more = forces;
  tissue_.fixed().clear(more);
  r.value += more.value;
  return space_.norm(r) / (scale + space_.norm(more));
}

// Half of the increment, a quarter, ...: the first on which no element is inside out and the
// residual is below the one before it. Forces of needles and cavities come in along the line, so
// that the residual falls at first wherever the tangent is that of the forces; rows that begin to
// hold or slip are no reason for it to fall, then the whole increment stays. False when even the
// shortest turns elements inside out.
bool Simulation::shorten(const State& past, const core::TimeStep& now, const Pass& pass,
                         const Iterate& before, const fem::OwnedField& forces, cavity::Shape& walls,
                         State& next, double& residual) const
{
  constexpr int most_halvings = 4;
  const fem::OwnedField whole = next.tissue.u;
  bool found = false;
  double part = 1.0;
  for (int halving = 0; halving < most_halvings && !found; ++halving) {
    part *= 0.5;
    const fem::OwnedField u{before.u.value + part * (whole.value - before.u.value)};
    if (!tissue_.possible(u)) continue;
    if (!pass.upright) next.tissue.u = u;
    if (!std::isfinite(before.residual)) break;
    const fem::OwnedField along{before.forces.value + part * (forces.value - before.forces.value)};
    const double here = unbalanced(past, u, now, along);
    if (!(here < before.residual)) continue;
    next.tissue.u = u;
    residual = here;
    found = true;
  }
  if (!pass.upright && !tissue_.possible(next.tissue.u)) return false;
  walls = walls_of(next);
  return true;
}

}  // namespace trocar::driver
