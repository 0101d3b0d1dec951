#pragma once

#include "insertion/deformed.hpp"
#include "insertion/ground.hpp"
#include "insertion/state.hpp"
#include "needle/needle.hpp"

// How a needle goes through tissue: its channel and the points that are born along it.
namespace trocar::insertion {

/// State of a needle that starts `inserted` deep along its direction: path and points are made
/// on the undeformed mesh. Throws Failure (65) when that path never meets the tissue.
InsertionState start(const Ground& ground, const needle::Needle& needle);

/// Events of a step, decided before the solve: the tip at its predicted place is mapped through
/// the old deformation; the path grows where nothing resists, points are born at the tip or
/// dropped ahead of it.
InsertionState advance(const Ground& ground, const InsertionState& old,
                       const needle::Shaft& predicted, const Deformed& tissue);

/// True when a needle that is not in its channel lies in the tissue all the same: its shaft went
/// in from the side, which nothing here models.
bool off_channel(const Ground& ground, const InsertionState& state, const needle::Shaft& shaft,
                 const Deformed& tissue);

/// Depth: length of the inserted path that lies in tissue [m].
double depth(const InsertionState& state);

/// Points are born up to the arc, where the tip is now.
void add_points_behind(const mesh::Mesh& mesh, InsertionState& state, double arc,
                       double needle_length);

}  // namespace trocar::insertion
