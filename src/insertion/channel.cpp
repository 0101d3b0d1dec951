#include "insertion/channel.hpp"

#include <algorithm>
#include <cmath>

#include "core/failure.hpp"
#include "insertion/growth.hpp"
#include "insertion/line_points.hpp"
#include "insertion/tip_events.hpp"

namespace trocar::insertion {
namespace {

bool passed(const mesh::Mesh& mesh, const InsertionState& state, std::size_t site, double arc)
{
  const Site& place = state.path.sites[site];
  return arc > 0.0 && place.arc <= arc + arc_tolerance(mesh, place.tet);
}

}  // namespace

void hold_behind(const Ground& ground, InsertionState& state, double arc,
                 const needle::Shaft& shaft)
{
  // The tip passed within this step what is newly held. That counts as having slipped for the whole
  // step: its friction acts at once, and the force has no dent where points are born.
  const double old_arc = std::max(state.tip_arc, 0.0);
  if (ground.along_line())
    return hold_line_behind(ground, state, arc, shaft.length - old_arc, shaft.radius);
  const mesh::Mesh& mesh = ground.mesh;
  while (!state.points.empty() &&
         !passed(mesh, state, static_cast<std::size_t>(state.points.back().site), arc))
    state.points.pop_back();
  state.tip_arc = arc;
  while (state.points.size() < state.path.sites.size() &&
         passed(mesh, state, state.points.size(), arc)) {
    CouplingPoint point;
    point.site = static_cast<int>(state.points.size());
    point.stuck = false;
    const double site_arc = state.path.sites[state.points.size()].arc;
    point.needle_arc = shaft.length + (site_arc - old_arc);
    state.points.push_back(point);
  }
}

InsertionState start(const Ground& ground, const needle::Needle& needle)
{
  const needle::BaseMotion& motion = needle.settings().motion;
  InsertionState state;
  if (!(motion.inserted > 0.0)) return state;
  const needle::Shaft shaft = needle.initial().shaft;
  const fem::GlobalField undeformed{core::VecX::Zero(3 * ground.mesh.node_count())};
  const Deformed tissue(ground.mesh, ground.locator, undeformed);
  const Vec3 tip = motion.entry + motion.inserted * motion.direction;
  grow(state.path, motion.entry, ground.field());
  grow_to(ground, state, {tip, tip, shaft, tissue, -1, false});
  if (first_tet(state.path) < 0)
    throw core::data_error("needle '" + needle.settings().name +
                           "': the inserted part lies outside the tissue (check -needle_entry, "
                           "-needle_direction and -needle_inserted)");
  state.phase = Phase::inserted;
  hold_behind(ground, state, state.path.length(), shaft);
  for (CouplingPoint& point : state.points) point.stuck = true;
  for (CouplingPoint& point : state.points) {
    const Site& site = state.path.sites[static_cast<std::size_t>(point.site)];
    point.needle_arc = needle::project(shaft, tissue.position(site.anchor)).s;
  }
  return state;
}

namespace {

InsertionState enter(const Ground& ground, const InsertionState& old,
                     const needle::Shaft& predicted, const Deformed& tissue)
{
  // The first entry counts: within one step the tip may have passed right through a thin wall.
  const Vec3 tip = predicted.tip();
  const auto entries = tissue.entries(predicted.x.front(), tip, ground.body_of_node);
  if (entries.empty()) return old;
  const Vec3& entry = entries.front().X;
  const int first = ground.tet_at(entry, entries.front().first_tet);
  InsertionState next;
  next.tip.punctures = old.tip.punctures;
  next.path.first_id = old.path.first_id + static_cast<int>(old.path.sites.size());
  if (ground.border(-1, first, entry) > 0.0) {
    touch_surface(ground, next, entry, first, predicted);
    next.tip.offset = tissue.position(next.tip.hold) - tissue.place(entry, next.tip.tet);
    return next;
  }
  const auto inside = tissue.reference_place(tip, entry);
  const bool same = inside && ground.body(inside->tet) == ground.body(entries.front().first_tet);
  const Vec3 X = same ? inside->X : tissue.reference_place_continued(tip, entries.front().last_tet);
  grow(next.path, entry, ground.field());
  const Vec3 passed = passed_place(ground, next, X, first, predicted);
  grow_to(ground, next, {passed, tip, predicted, tissue, first});
  if (first_tet(next.path) < 0) return old;
  next.phase = Phase::inserted;
  press(ground, next, next.path.length(), predicted, tissue);
  hold_behind(ground, next, next.path.length(), predicted);
  return next;
}

}  // namespace

namespace {

/// `passed_place` of a tip that goes on along its path. In a body that it comes into, the friction
/// of what it passes begins anew.
Vec3 passed_again(const Ground& ground, const InsertionState& old, const Aim& to,
                  const needle::Shaft& shaft)
{
  const PathRun run = run_at(old.path, std::min(to.arc, old.path.length()));
  if (old.tip_arc >= run.begin) return passed_place(ground, old, to.X, to.tet, shaft);
  InsertionState here = old;
  here.points.clear();
  here.tip_arc = run.begin;
  return passed_place(ground, here, to.X, to.tet, shaft);
}

}  // namespace

InsertionState advance(const Ground& ground, const InsertionState& old,
                       const needle::Shaft& predicted, const Deformed& tissue)
{
  if (old.phase == Phase::contact) return old;  // `settle_tip` decides after the solve
  if (first_tet(old.path) < 0) return enter(ground, old, predicted, tissue);

  const Vec3 tip = tip_on_way(ground, old, predicted, tissue);
  Aim to = aim(ground, old, tip, tissue);
  if (old.phase == Phase::withdrawn) {
    if (!to.inside) return old;
    // A tip that comes back far beside its old channel cuts a new one; the old one is forgotten.
    if (distance(old.path, to.X) > 0.3 * local_edge(ground.mesh, first_tet(old.path)))
      return enter(ground, old, predicted, tissue);
  }
  InsertionState next = old;
  double arc = to.arc;
  if (ground.along_line() && arc > old.tip_arc && old.tip_arc > 0.0) {
    to.X = passed_again(ground, old, to, predicted);
    arc = arc_nearest(next.path, run_at(next.path, std::min(arc, next.path.length())), to.X);
  }
  const double tolerance = arc_tolerance(ground.mesh, to.tet);
  if (std::abs(arc - old.tip_arc) > tolerance) next.withdrawing = arc < old.tip_arc;
  if (arc > next.path.length() + 1e-3 * tolerance) {
    if (resistance(ground, old) <= 0.0)
      grow_to(ground, next, {to.X, tip, predicted, tissue, to.tet});
    arc = next.path.length();
  }
  // A tip outside the tissue in front of the entry has left the channel, even where the
  // extrapolated map gives a small positive arc.
  if (!to.inside && to.behind && arc > 0.0 && arc < tolerance) arc = 0.0;
  press(ground, next, arc, predicted, tissue);
  if (next.tip.pressed) arc = next.path.length();
  next.phase = arc > 0.0 ? Phase::inserted : Phase::withdrawn;
  hold_behind(ground, next, arc, predicted);
  return next;
}

bool off_channel(const Ground& ground, const InsertionState& state, const needle::Shaft& shaft,
                 const Deformed& tissue)
{
  if (state.phase == Phase::inserted) return false;
  // The last part `clear` [m] of the shaft is not checked: the tip may touch the surface, and may
  // stand in the dent that it makes.
  double clear = 1e-3 * shaft.length;
  if (state.phase == Phase::contact) {
    const double edge = local_edge(ground.mesh, state.tip.tet);
    clear = 2.0 * std::max(ground.settings.tip.radius, edge);
  }
  for (std::size_t e = 0; e + 1 < shaft.x.size(); ++e) {
    const double begin = static_cast<double>(e) * shaft.element_length();
    const double part = std::min(1.0, (shaft.length - clear - begin) / shaft.element_length());
    if (part > 0.0 && tissue.meets(shaft.x[e], shaft.x[e] + part * (shaft.x[e + 1] - shaft.x[e])))
      return true;
  }
  return false;
}

double depth(const InsertionState& state)
{
  return state.path.empty() ? 0.0 : tissue_length(state.path, state.tip_arc);
}

}  // namespace trocar::insertion
