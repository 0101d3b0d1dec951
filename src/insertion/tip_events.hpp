#pragma once

#include "insertion/coupling.hpp"
#include "insertion/deformed.hpp"

// Events of the tip: it meets borders, presses on them, slides and cuts.
namespace trocar::insertion {

/// Puts the tip on the surface of a tet at X (reference); a new path begins there.
void touch_surface(const Ground& ground, InsertionState& state, const Vec3& X, int tet,
                   const needle::Shaft& shaft);

/// Force at which the tissue at the end of the path yields [N]; 0: nothing resists.
double resistance(const Ground& ground, const InsertionState& state);

/// Decides whether the tip is pressed. A tip at `arc` [m] becomes pressed at the end of its path if
/// something resists there, and stays so until it comes apart. Its gap is measured from that place.
void press(const Ground& ground, InsertionState& state, double arc, const needle::Shaft& shaft,
           const Deformed& tissue);

/// Vector along the shaft from where a pressed tip closes its gap to the end of its path now [m];
/// zero for a tip that is not pressed. The gap is measured to the mean of the support, and under
/// load the end of the path moves farther than this mean.
Vec3 lead(const InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue);

/// Where the tip is on its way through the tissue of the mesh [m]: ahead of the needle's end by
/// `lead`, and behind by what the mesh hides of the tissue's motion there.
Vec3 tip_on_way(const Ground& ground, const InsertionState& state, const needle::Shaft& shaft,
                const Deformed& tissue);

/// Updates path and tip after the solve, with shaft and tissue at the end of the step. Where the
/// tissue yielded, the path grows by the tip's advance, up to the next border. A tip that slid on a
/// surface touches it where it now is. A tip that came apart leaves the surface, or gets its
/// present place on the path.
void settle_tip(const Ground& ground, InsertionState& state, const CouplingReport& report,
                const needle::Shaft& shaft, const Deformed& tissue);

}  // namespace trocar::insertion
