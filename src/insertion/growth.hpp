#pragma once

#include "insertion/deformed.hpp"
#include "insertion/ground.hpp"
#include "insertion/state.hpp"
#include "needle/shaft.hpp"

// How a path grows: through tissue up to a border that resists, and from one body into the next.
namespace trocar::insertion {

/// Where a tip goes: to `x` in the world, which is the reference place `X` of the body that its
/// path ends in. Borrows everything.
struct TipWay
{
  Vec3 X, x;  ///< [m]
  const needle::Shaft& shaft;
  const Deformed& tissue;
  int tet = -1;         ///< in which a path without tissue begins; -1: it begins outside
  bool pierces = true;  ///< borders stop the tip; false: they count as pierced
};

/// Grows the path to where the tip goes, or only to the first border that resists. That border's
/// force then is the tip's threshold. A path leaves its body where the *deformed* body ends before
/// the next one. It goes on where the tip enters the next body, as far along the needle as the two
/// places are apart now, and each of the two surfaces is pierced by itself. So bodies may have slid
/// along each other.
void grow_to(const Ground& ground, InsertionState& state, const TipWay& way);

/// Place of a tip in the reference, and on its path.
struct Aim
{
  Vec3 X;       ///< in the frame of the body of `tet`, extrapolated where the tip is not in it [m]
  double arc;   ///< on the path [m]
  int tet;      ///< at the end of the run that is nearer to the tip
  bool inside;  ///< the tip is in the tissue
  bool behind;  ///< `tet` is at the begin of the path
};
/// The aim of a tip at the world place x, seen from its place in the old state.
Aim aim(const Ground& ground, const InsertionState& old, const Vec3& x, const Deformed& tissue);

/// Reference place of the world point x in the body of a tet, extrapolated where x is not in it.
Vec3 reference_in(const Ground& ground, const Deformed& tissue, const Vec3& x, int tet);

}  // namespace trocar::insertion
