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

// Half of the increment, a quarter, ...: the first on which no element is inside out and less is
// unbalanced than before it. Forces of needles and cavities come in along the line, so that the
// residual falls at first wherever the tangent is that of the forces; rows that begin to hold or
// slip are no reason for it to fall, then the whole increment stays. False when even the shortest
// turns elements inside out, or one increment after the other does.
bool Simulation::shorten(const State& past, const core::TimeStep& now, bool upright,
                         Iterate& before, fem::OwnedField& forces, cavity::Shape& walls,
                         State& next, double& unbalanced_part) const
{
  constexpr int most_halvings = 4, most_turnovers = 4;
  before.turnovers = upright ? 0 : before.turnovers + 1;
  if (before.turnovers > most_turnovers) return false;
  const fem::OwnedField whole = next.tissue.u, all = forces;
  bool possible = upright;
  double part = 1.0;
  for (int halving = 0; halving < most_halvings; ++halving) {
    part *= 0.5;
    const fem::OwnedField u{before.u.value + part * (whole.value - before.u.value)};
    if (!tissue_.possible(u)) continue;
    const bool first = !std::isfinite(before.unbalanced);  // nothing to compare with
    fem::OwnedField along = all;
    if (!first) along.value = before.forces.value + part * (all.value - before.forces.value);
    const double here = unbalanced(past, u, now, along);
    const bool descends = first || here < before.unbalanced;
    if (upright && !descends) continue;
    possible = true;
    next.tissue.u = u;
    forces = std::move(along);
    unbalanced_part = here;
    if (descends) break;
  }
  if (possible) walls = walls_of(next);
  return possible;
}

}  // namespace trocar::driver
