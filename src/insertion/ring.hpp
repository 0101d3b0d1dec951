#pragma once

#include "insertion/ground.hpp"

namespace trocar::insertion {

/// A circle around the axis of a needle, on which the tissue's displacement is averaged and on
/// which its forces act. A bare line hits the tets as chance will have it, and how thick it seems
/// scatters by a tenth with its place in them; the mean over a circle does not.
struct Ring
{
  double radius;  ///< [m]
  int points;     ///< even
};

/// Mean of the places on a circle around X, a place in `tet`, normal to `axis` (a unit vector).
/// Near the surface of the tissue two opposite points come nearer to the axis alike, until both are
/// in the tissue. So the mean place always is X, and a force on it has the moment of one on the
/// axis. Points beyond a void or in another body do not count as in the tissue.
constraint::Anchor ring_around(const Ground& ground, const Vec3& X, int tet, const Vec3& axis,
                               const Ring& ring);

}  // namespace trocar::insertion
