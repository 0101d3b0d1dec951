#include <algorithm>

#include "insertion/insertion.hpp"
#include "mesh/quadratic.hpp"

// What the tip meets and what becomes of it: borders, pressing, sliding, cutting.
namespace trocar::insertion {
namespace {

/// Outward normal of the tet's face nearest to X.
Vec3 face_normal(const mesh::Mesh& mesh, int tet, const Vec3& X)
{
  const auto corner = mesh::corners(mesh, tet);
  const Eigen::Vector4d weight = mesh::local_coordinates(mesh::positions(mesh, tet), X);
  Eigen::Index opposite = 0;
  weight.minCoeff(&opposite);
  const auto at = [&](Eigen::Index k) {
    return corner[static_cast<std::size_t>((opposite + k) % 4)];
  };
  const Vec3 normal = (at(2) - at(1)).cross(at(3) - at(1)).normalized();
  return normal.dot(at(0) - at(1)) > 0.0 ? Vec3(-normal) : normal;
}

core::Mat3 frame_of(const needle::ShaftPoint& end)
{
  core::Mat3 frame;
  frame << end.tangent, end.normal_1, end.normal_2;
  return frame;
}

/// The normal first, then what the needle's own normals have across it: the frame turns with body
/// and needle.
core::Mat3 disc_frame(const Vec3& normal, const needle::ShaftPoint& end)
{
  const auto across = [&](const Vec3& d) -> Vec3 { return d - normal.dot(d) * normal; };
  const Vec3 one = across(end.normal_1), other = across(end.normal_2);
  core::Mat3 frame;
  frame.col(0) = normal;
  frame.col(1) = (one.norm() > 0.1 ? one : other).normalized();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

}  // namespace

/// Force it takes to go at X from one tet into another (-1: none) [N]: a membrane's threshold, and
/// what is cut with a force is not entered without it.
double Insertion::border(int from, int to, const Vec3& X) const
{
  const auto cutting = [&](int tet) {
    return tet < 0 ? 0.0
                   : settings_.tip.cutting[static_cast<std::size_t>(
                         mesh_->region[static_cast<std::size_t>(tet)])];
  };
  const double membrane = membranes_.threshold(from, to, X);
  return cutting(from) > 0.0 ? membrane : std::max(membrane, cutting(to));
}

/// The tip stands on the surface at X, which is the path from now on.
void Insertion::touch_surface(InsertionState& state, const Vec3& X,
                              const needle::Shaft& shaft) const
{
  const int tet = locator_->tet_at(X);
  const double edge = local_edge(*mesh_, tet);
  const Vec3 normal = face_normal(*mesh_, tet, X);
  const int first_id = state.path.first_id;
  state.path = {};
  state.path.first_id = first_id;
  grow(state.path, X, *mesh_, *locator_, settings_.placement);
  state.phase = Phase::contact;
  state.tip.pressed = true;
  state.tip.wall = true;
  state.tip.threshold = border(-1, tet, X);
  state.tip.tet = tet;
  state.tip.radius = std::max(settings_.tip.radius, edge);
  state.tip.hold = tip_support(*mesh_, *locator_, {X, tet, state.tip.radius},
                               disc_frame(normal, needle::shaft_at(shaft, shaft.length)), true);
}

/// Grows the path towards X, but not through a border that resists: there it ends, and that
/// border's force is what the tip meets.
void Insertion::grow_to(InsertionState& state, const Vec3& X) const
{
  state.tip.threshold = 0.0;
  state.tip.wall = false;
  if (!resists_) return grow(state.path, X, *mesh_, *locator_, settings_.placement);
  const Path before = state.path;
  grow(state.path, X, *mesh_, *locator_, settings_.placement);
  for (std::size_t i = std::max<std::size_t>(before.pieces.size(), 1); i < state.path.pieces.size();
       ++i) {
    const int from = state.path.pieces[i - 1].tet, to = state.path.pieces[i].tet;
    if (from == to) continue;
    const double edge = local_edge(*mesh_, std::max(from, to));
    const double arc = state.path.pieces[i].begin;
    const double part = (arc - before.length()) / (X - before.vertex.back()).norm();
    const Vec3 place = before.vertex.back() + part * (X - before.vertex.back());
    const double threshold = border(from, to, place);
    // Oblique to a membrane the path may weave through it: pierced is pierced, an edge around.
    const bool pierced = threshold == state.tip.pierced_force &&
                         arc <= state.tip.pierced_arc + std::max(settings_.tip.radius, edge);
    if (threshold <= 0.0 || pierced) continue;
    state.path = before;
    grow(state.path, place, *mesh_, *locator_, settings_.placement);
    state.tip.threshold = threshold;
    state.tip.wall = from < 0 || to < 0;
    state.tip.tet = to >= 0 ? to : from;
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
/// it comes apart. Its gap counts from that place.
void Insertion::press(InsertionState& state, double arc, const needle::Shaft& shaft,
                      const Deformed& tissue) const
{
  TipState& tip = state.tip;
  const bool was_pressed = tip.pressed;
  const int tet = tip.threshold > 0.0 ? tip.tet : last_tet(state.path);
  tip.pressed = false;
  if (tet < 0 || resistance(state) <= 0.0) return;
  const double tolerance = arc_tolerance(*mesh_, tet);
  tip.pressed = was_pressed || arc >= state.path.length() - tolerance;
  if (!tip.pressed || was_pressed) return;
  const Vec3& X = state.path.vertex.back();
  const needle::ShaftPoint end = needle::shaft_at(shaft, shaft.length);
  tip.radius = std::max(settings_.tip.radius, local_edge(*mesh_, tet));
  tip.tet = tet;
  tip.hold = tip_support(*mesh_, *locator_, {X, tet, tip.radius},
                         tip.wall ? disc_frame(face_normal(*mesh_, tet, X), end) : frame_of(end),
                         tip.wall);
  tip.offset = tissue.position(tip.hold) - tissue.place(X, tet);
}

/// How far along the shaft the place a pressed tip stands on lies ahead of where it would close the
/// gap: under load the place yields more than the mean of the support, by which the gap is
/// measured.
Vec3 Insertion::lead(const InsertionState& state, const needle::Shaft& shaft,
                     const Deformed& tissue) const
{
  if (!state.tip.pressed) return Vec3::Zero();
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const Vec3 closed = tissue.position(state.tip.hold) - state.tip.offset;
  const Vec3 place = tissue.place(state.path.vertex.back(), state.tip.tet);
  return tangent * tangent.dot(place - closed);
}

/// The tip, pressed on a surface, stands on it where its axis meets it now; beside the body there
/// is none, and the tip has left. True when it stands.
bool Insertion::stand(InsertionState& state, const needle::Shaft& shaft,
                      const Deformed& tissue) const
{
  const double edge = local_edge(*mesh_, state.tip.tet);
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const Vec3 ahead = shaft.tip() + lead(state, shaft, tissue) + edge * tangent;
  const Vec3 stood = state.path.vertex.back();
  const auto entries = tissue.entries(shaft.x.front(), ahead);
  const auto nearest =
      std::min_element(entries.begin(), entries.end(), [&](const auto& a, const auto& b) {
        return (a.X - stood).squaredNorm() < (b.X - stood).squaredNorm();
      });
  const bool there = nearest != entries.end();
  if (there && locator_->tet_at(nearest->X) >= 0) touch_surface(state, nearest->X, shaft);
  if (!there || state.tip.threshold <= 0.0) leave_surface(state);
  return state.tip.pressed;
}

void Insertion::leave_surface(InsertionState& state) const
{
  const int first_id = state.path.first_id;
  state.path = {};
  state.path.first_id = first_id;
  state.phase = Phase::outside;
  state.tip.pressed = false;
}

void Insertion::settle(InsertionState& state, const CouplingReport& report,
                       const needle::Shaft& shaft, const Deformed& tissue) const
{
  if (report.tip == TipOutcome::holds) return;
  const bool on_surface = state.phase == Phase::contact;
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  if (on_surface && report.tip == TipOutcome::apart) return leave_surface(state);
  if (on_surface && !stand(state, shaft, tissue)) return;
  if (report.tip == TipOutcome::slides) {
    state.tip.offset = tissue.position(state.tip.hold) - shaft.tip();
    return;
  }
  // On a surface the channel begins where the axis meets it; else it ends where the tip is.
  Vec3 tip = shaft.tip() + lead(state, shaft, tissue);
  if (on_surface)
    tip = tissue.place(state.path.vertex.back(), state.tip.tet) - report.tip_gap * tangent;
  const auto inside = tissue.reference_place(tip, state.path.vertex.back());
  const Vec3 X = inside ? *inside : tissue.reference_place_continued(tip, state.tip.tet);
  state.tip.pressed = false;
  if (report.tip == TipOutcome::apart) {
    state.tip_arc = std::clamp(arc_nearest(state.path, X), 0.0, state.path.length());
    return;
  }
  if (state.tip.threshold > 0.0) {
    ++state.tip.punctures;
    state.tip.pierced_arc = state.path.length();
    state.tip.pierced_force = state.tip.threshold;
  }
  grow_to(state, X);
  state.phase = Phase::inserted;
  press(state, state.path.length(), shaft, tissue);
  // Where the tissue gave way to the tip it is closed on it, in the bevel's direction as well. A
  // border on its way the tip is beyond by the rest of its advance: to that the next step opens.
  if (state.tip.pressed) {
    state.tip.offset = tissue.position(state.tip.hold) - shaft.tip();
    const Vec3 end = tissue.place(state.path.vertex.back(), state.tip.tet);
    if (state.tip.threshold > 0.0)
      state.tip.offset += std::max(tangent.dot(tip - end), 0.0) * tangent;
  }
  state.tip_arc = state.path.length();
  const std::size_t known = state.points.size();
  add_points_behind(state, state.path.length(), shaft.length);
  // The step is over: new points stand where they are on the shaft, which under load is a little
  // ahead of where the path says.
  for (std::size_t k = known; k < state.points.size(); ++k) {
    const Site& site = state.path.sites[static_cast<std::size_t>(state.points[k].site)];
    state.points[k].needle_arc = needle::project(shaft, tissue.position(site.anchor)).s;
  }
}

}  // namespace trocar::insertion
