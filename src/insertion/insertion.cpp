#include "insertion/insertion.hpp"

#include <algorithm>
#include <cmath>

#include "core/failure.hpp"

namespace trocar::insertion {
namespace {

/// First and last tet of the path: where the needle goes in, and where its end is.
int first_tet(const Path& path)
{
  for (const Piece& piece : path.pieces)
    if (piece.tet >= 0) return piece.tet;
  return -1;
}
int last_tet(const Path& path)
{
  for (auto piece = path.pieces.rbegin(); piece != path.pieces.rend(); ++piece)
    if (piece->tet >= 0) return piece->tet;
  return -1;
}

/// Outward normal of the tet's face nearest to X.
Vec3 face_normal(const mesh::Mesh& mesh, int tet, const Vec3& X)
{
  const auto corner = mesh::corners(mesh, tet);
  const Eigen::Vector4d weight = mesh::barycentric(corner, X);
  Eigen::Index opposite = 0;
  weight.minCoeff(&opposite);
  const auto at = [&](Eigen::Index k) {
    return corner[static_cast<std::size_t>((opposite + k) % 4)];
  };
  const Vec3 normal = (at(2) - at(1)).cross(at(3) - at(1)).normalized();
  return normal.dot(at(0) - at(1)) > 0.0 ? Vec3(-normal) : normal;
}

}  // namespace

Insertion::Insertion(const mesh::Mesh& mesh, const mesh::Locator& locator,
                     InsertionSettings settings)
    : mesh_(&mesh),
      locator_(&locator),
      settings_(std::move(settings)),
      membranes_(mesh, settings_.puncture)
{
  settings_.tip.cutting.resize(mesh.volumes.size(), 0.0);
}

InsertionState Insertion::start(const needle::Needle& needle) const
{
  const needle::BaseMotion& motion = needle.settings().motion;
  InsertionState state;
  if (!(motion.inserted > 0.0)) return state;
  grow(state.path, motion.entry, *mesh_, *locator_, settings_.placement);
  grow(state.path, motion.entry + motion.inserted * motion.direction, *mesh_, *locator_,
       settings_.placement);
  if (first_tet(state.path) < 0)
    throw core::data_error("needle '" + needle.settings().name +
                           "': the inserted part lies outside the tissue (check -needle_entry, "
                           "-needle_direction and -needle_inserted)");
  state.phase = Phase::inserted;
  add_points_behind(state, state.path.length(), 0.0);
  for (CouplingPoint& point : state.points) point.stuck = true;
  const fem::GlobalField undeformed{core::VecX::Zero(3 * mesh_->node_count())};
  const Deformed tissue(*mesh_, *locator_, undeformed);
  const needle::Shaft shaft = needle.initial().shaft;
  for (CouplingPoint& point : state.points) {
    const Site& site = state.path.sites[static_cast<std::size_t>(point.site)];
    point.needle_arc = needle::project(shaft, tissue.position(site.anchor)).s;
  }
  return state;
}

InsertionState Insertion::advance(const InsertionState& old, const needle::Shaft& predicted,
                                  const Deformed& tissue) const
{
  if (old.phase == Phase::contact) return keep_contact(old, predicted, tissue);
  if (old.path.empty()) return enter(old, predicted, tissue);

  const Vec3 tip = predicted.tip() + lead(old, predicted, tissue);
  const auto inside = tissue.reference_place(tip, old.path.vertex.back());
  if (old.phase == Phase::withdrawn) {
    if (!inside) return old;
    // Beside the old channel the tip cuts a new one; the old one is then forgotten.
    const double beside = distance(old.path, *inside);
    if (beside > 0.3 * arc_tolerance(*mesh_, first_tet(old.path)) / relative_tolerance)
      return enter(old, predicted, tissue);
  }
  // Beyond its tets the map of the nearest end is continued: the tip may be out at either side.
  const bool behind = old.tip_arc <= 0.5 * old.path.length();
  const int end_tet = behind ? first_tet(old.path) : last_tet(old.path);
  const Vec3 X = inside ? *inside : tissue.reference_place_continued(tip, end_tet);
  InsertionState next = old;
  double arc = arc_nearest(next.path, X);
  const double tolerance = arc_tolerance(*mesh_, end_tet);
  if (std::abs(arc - old.tip_arc) > tolerance) next.withdrawing = arc < old.tip_arc;
  if (arc > next.path.length() + 1e-3 * tolerance) {
    if (resistance(old) <= 0.0) grow_to(next, X);
    arc = next.path.length();
  }
  // A tip outside the tissue in front of the entry has left the channel, whatever the map says.
  if (!inside && behind && arc > 0.0 && arc < tolerance) arc = 0.0;
  press(next, arc);
  if (next.tip.pressed) arc = next.path.length();
  next.phase = arc > 0.0 ? Phase::inserted : Phase::withdrawn;
  drop_points_ahead(next, arc);
  add_points_behind(next, arc, predicted.length);
  return next;
}

bool Insertion::astray(const InsertionState& state, const needle::Shaft& shaft,
                       const Deformed& tissue) const
{
  if (state.phase == Phase::contact || state.phase == Phase::inserted) return false;
  for (std::size_t e = 0; e + 1 < shaft.x.size(); ++e) {
    // The tip itself may touch the surface.
    const double end = e + 2 == shaft.x.size() ? 0.99 : 1.0;
    if (tissue.meets(shaft.x[e], shaft.x[e] + end * (shaft.x[e + 1] - shaft.x[e]))) return true;
  }
  return false;
}

InsertionState Insertion::enter(const InsertionState& old, const needle::Shaft& predicted,
                                const Deformed& tissue) const
{
  const auto entry = tissue.entry(predicted.x.front(), predicted.tip());
  const auto X = entry ? tissue.reference_place(predicted.tip(), *entry) : std::nullopt;
  if (!X) return old;
  InsertionState next;
  next.tip.punctures = old.tip.punctures;
  next.path.first_id = old.path.first_id + static_cast<int>(old.path.sites.size());
  grow(next.path, *entry, *mesh_, *locator_, settings_.placement);
  const int tet = locator_->tet_at(*entry);
  if (tet >= 0) {
    // What is cut with a force is not entered without it.
    const auto region = static_cast<std::size_t>(mesh_->region[static_cast<std::size_t>(tet)]);
    next.tip.threshold =
        std::max(membranes_.threshold(-1, tet, *entry), settings_.tip.cutting[region]);
  }
  if (next.tip.threshold > 0.0) {
    touch_surface(next, *entry);
    return next;
  }
  grow_to(next, *X);
  if (first_tet(next.path) < 0) return old;
  next.phase = Phase::inserted;
  press(next, next.path.length());
  add_points_behind(next, next.path.length(), predicted.length);
  return next;
}

/// On a surface the tip stays where it touched, or goes where it slid.
InsertionState Insertion::keep_contact(const InsertionState& old, const needle::Shaft& predicted,
                                       const Deformed& tissue) const
{
  InsertionState next = old;
  if (!old.tip.slid) return next;
  const auto entry = tissue.entry(predicted.x.front(), predicted.tip());
  if (entry && locator_->tet_at(*entry) >= 0) {
    next.path.vertex.front() = *entry;
    touch_surface(next, *entry);
  }
  return next;
}

void Insertion::touch_surface(InsertionState& state, const Vec3& X) const
{
  const int tet = locator_->tet_at(X);
  const double edge = arc_tolerance(*mesh_, tet) / relative_tolerance;
  const Vec3 normal = face_normal(*mesh_, tet, X);
  state.phase = Phase::contact;
  state.tip.pressed = true;
  state.tip.tet = tet;
  state.tip.hold =
      tip_support(*mesh_, *locator_, X, tet, std::max(settings_.tip.radius, edge), &normal);
}

/// Grows the path towards X, but not through a membrane: there it ends, and the membrane's
/// threshold is what the tip meets. One that the path already ends at has been pierced.
void Insertion::grow_to(InsertionState& state, const Vec3& X) const
{
  state.tip.threshold = 0.0;
  const Path before = state.path;
  grow(state.path, X, *mesh_, *locator_, settings_.placement);
  if (!membranes_.any()) return;
  for (std::size_t i = std::max<std::size_t>(before.pieces.size(), 1); i < state.path.pieces.size();
       ++i) {
    const Piece& into = state.path.pieces[i];
    if (into.begin <= before.length() * (1.0 + 1e-12)) continue;
    const double part = (into.begin - before.length()) / (X - before.vertex.back()).norm();
    const Vec3 border = before.vertex.back() + part * (X - before.vertex.back());
    const double threshold = membranes_.threshold(state.path.pieces[i - 1].tet, into.tet, border);
    if (threshold <= 0.0) continue;
    state.path = before;
    grow(state.path, border, *mesh_, *locator_, settings_.placement);
    state.tip.threshold = threshold;
    return;
  }
}

/// Force at which the tissue at the end of the path yields [N]; 0: nothing resists.
double Insertion::resistance(const InsertionState& state) const
{
  if (state.tip.threshold > 0.0 || state.path.pieces.empty()) return state.tip.threshold;
  const int tet = state.path.pieces.back().tet;
  if (tet < 0) return 0.0;
  return settings_.tip
      .cutting[static_cast<std::size_t>(mesh_->region[static_cast<std::size_t>(tet)])];
}

/// A tip that comes to the end of its path where something resists is pressed from then on, until
/// it comes apart.
void Insertion::press(InsertionState& state, double arc) const
{
  const int tet = last_tet(state.path);
  const double tolerance = arc_tolerance(*mesh_, tet);
  const bool at_end = state.tip.pressed || arc >= state.path.length() - tolerance;
  state.tip.pressed = at_end && resistance(state) > 0.0;
  if (!state.tip.pressed) return;
  const Vec3& X = state.path.vertex.back();
  const double edge = tolerance / relative_tolerance;
  state.tip.tet = tet;
  state.tip.hold =
      tip_support(*mesh_, *locator_, X, tet, std::max(settings_.tip.radius, edge), nullptr);
}

/// How far along the shaft the place a pressed tip stands on lies ahead of the mean of its support:
/// what the tip's gap is measured by is that mean, so its place in the tissue is the tip plus this.
Vec3 Insertion::lead(const InsertionState& state, const needle::Shaft& shaft,
                     const Deformed& tissue) const
{
  if (!state.tip.pressed) return Vec3::Zero();
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const Vec3 ahead =
      tissue.place(state.path.vertex.back(), state.tip.tet) - tissue.position(state.tip.hold);
  return tangent * tangent.dot(ahead);
}

void Insertion::cut(InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue) const
{
  const Vec3 tip = shaft.tip() + lead(state, shaft, tissue);
  const auto inside = tissue.reference_place(tip, state.path.vertex.back());
  const Vec3 X = inside ? *inside : tissue.reference_place_continued(tip, state.tip.tet);
  if (state.tip.threshold > 0.0) ++state.tip.punctures;
  grow_to(state, X);
  state.phase = Phase::inserted;
  state.tip.pressed = false;
  press(state, state.path.length());
  state.tip_arc = state.path.length();
  add_points_behind(state, state.path.length(), shaft.length);
}

bool Insertion::passed(const InsertionState& state, std::size_t site, double arc) const
{
  const Site& place = state.path.sites[site];
  return arc > 0.0 && place.arc <= arc + arc_tolerance(*mesh_, place.tet);
}

void Insertion::drop_points_ahead(InsertionState& state, double arc) const
{
  while (!state.points.empty() &&
         !passed(state, static_cast<std::size_t>(state.points.back().site), arc))
    state.points.pop_back();
}

void Insertion::add_points_behind(InsertionState& state, double arc, double needle_length) const
{
  const double old_arc = std::max(state.tip_arc, 0.0);
  state.tip_arc = arc;
  while (state.points.size() < state.path.sites.size() && passed(state, state.points.size(), arc)) {
    CouplingPoint point;
    point.site = static_cast<int>(state.points.size());
    point.stuck = false;
    // The tip passed it within the step; it counts as having slipped the whole step, so that its
    // friction is there at once and the force has no dent where points are born. Where the tip
    // cuts, the step is over and the point takes the place on the shaft that it has.
    const double site_arc = state.path.sites[state.points.size()].arc;
    point.needle_arc = needle_length + (site_arc - old_arc);
    state.points.push_back(point);
  }
}

}  // namespace trocar::insertion
