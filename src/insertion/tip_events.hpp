#pragma once

#include "insertion/coupling.hpp"
#include "insertion/deformed.hpp"

// What the tip meets and what becomes of it: borders, pressing, sliding, cutting.
namespace trocar::insertion {

/// The tip stands on the surface at X, which is the path from now on.
void touch_surface(const Ground& ground, InsertionState& state, const Vec3& X,
                   const needle::Shaft& shaft);

/// Grows the path towards X, but not through a border that resists: there it ends, and that
/// border's force is what the tip meets.
void grow_to(const Ground& ground, InsertionState& state, const Vec3& X);

/// Force at which the tissue at the end of the path yields [N]; 0: nothing resists.
double resistance(const Ground& ground, const InsertionState& state);

/// A tip that comes to the end of its path where something resists is pressed from then on, until
/// it comes apart. Its gap counts from that place.
void press(const Ground& ground, InsertionState& state, double arc, const needle::Shaft& shaft,
           const Deformed& tissue);

/// How far along the shaft the place a pressed tip stands on lies ahead of where it would close the
/// gap: under load the place yields more than the mean of the support, by which the gap is
/// measured.
Vec3 lead(const InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue);

/// What the tip did in the step, once shaft and tissue are where they end: where the tissue
/// yielded the path grows by the tip's advance, up to the next border; on a surface it touches
/// where it slid to; a tip that came apart is where it is.
void settle_tip(const Ground& ground, InsertionState& state, const CouplingReport& report,
                const needle::Shaft& shaft, const Deformed& tissue);

}  // namespace trocar::insertion
