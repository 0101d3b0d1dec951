#pragma once

#include "insertion/deformed.hpp"
#include "insertion/ground.hpp"
#include "insertion/state.hpp"
#include "needle/needle.hpp"

// How a needle goes through tissue: it cuts a channel, and coupling points are born along it.
namespace trocar::insertion {

/// State of a needle that starts `BaseMotion::inserted` [m] deep along its direction. Path and
/// points are made on the undeformed mesh. Throws Failure (65) when the path never meets the
/// tissue.
InsertionState start(const Ground& ground, const needle::Needle& needle);

/// Events of a step, decided before the solve. The old deformation maps the predicted tip to the
/// reference. The path grows to there where nothing resists. Points are born behind the tip and
/// dropped ahead of it.
InsertionState advance(const Ground& ground, const InsertionState& old,
                       const needle::Shaft& predicted, const Deformed& tissue);

/// True when the shaft of a needle that is not in a channel lies in the tissue. Such a shaft went
/// in from the side, which is not modelled.
bool off_channel(const Ground& ground, const InsertionState& state, const needle::Shaft& shaft,
                 const Deformed& tissue);

/// Depth: length of the inserted path that lies in tissue [m].
double depth(const InsertionState& state);

/// Moves the tip to `arc` on the path [m]: drops coupling points ahead of it and adds those that
/// it has passed.
void hold_behind(const Ground& ground, InsertionState& state, double arc,
                 const needle::Shaft& shaft);

}  // namespace trocar::insertion
