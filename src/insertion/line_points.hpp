#pragma once

#include "insertion/coupling.hpp"

// The points of a needle that is coupled along a line, one for every hat, and the way of its tip.
namespace trocar::insertion {

/// Index of a hat's point in InsertionState::points, which are in order of hats; -1: it has none.
int point_of(const InsertionState& state, int hat);

/// Length of path that every point holds, see `tributary_lengths`.
core::MatX lengths_of_hats(const mesh::Mesh& mesh, const InsertionState& state);

/// How much farther the tissue at the tip is moved by the forces of the shaft than the mesh shows,
/// in the world [m]; zero unless the needle is coupled along a line. Without it the depth would
/// change with the mesh, as the logarithm of its size.
Vec3 hidden_motion_at_tip(const Ground& ground, const InsertionState& state,
                          const needle::Shaft& shaft);

/// Where a tip gets that seems to go from its place on the path to the reference place X, from or
/// in `tet`: the friction of what it passes moves the tissue on before it (see `length_passed`). X
/// itself unless the needle is coupled along a line.
Vec3 passed_place(const Ground& ground, const InsertionState& state, const Vec3& X, int tet,
                  const needle::Shaft& shaft);

/// Moves the tip of a needle that is coupled along a line to `arc` [m]: grid and stations behind
/// the tip, and a coupling point for every hat that holds a piece of the path. `needle_arc`: place
/// on the needle at the arc 0 of the path, of the piece newly passed [m].
void hold_line_behind(const Ground& ground, InsertionState& state, double arc, double needle_arc,
                      double radius);

}  // namespace trocar::insertion
