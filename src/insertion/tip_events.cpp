#include "insertion/tip_events.hpp"

#include <algorithm>

#include "insertion/channel.hpp"
#include "insertion/growth.hpp"
#include "insertion/line_points.hpp"
#include "mesh/quadratic.hpp"

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

/// Frame of a disc: first the face normal, then a normal of the needle projected into the face. So
/// results do not change when mesh and needle are rotated together.
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

void touch_surface(const Ground& ground, InsertionState& state, const Vec3& X, int tet,
                   const needle::Shaft& shaft)
{
  const double edge = local_edge(ground.mesh, tet);
  const Vec3 normal = face_normal(ground.mesh, tet, X);
  const int first_id = state.path.first_id;
  state.path = {};
  state.path.first_id = first_id;
  grow(state.path, X, ground.field());
  state.phase = Phase::contact;
  state.tip.pressed = true;
  state.tip.wall = true;
  state.tip.threshold = ground.border(-1, tet, X);
  state.tip.tet = tet;
  state.tip.radius = std::max(ground.settings.tip.radius, edge);
  state.tip.hold = tip_support(ground.mesh, ground.locator, {X, tet, state.tip.radius},
                               disc_frame(normal, needle::shaft_at(shaft, shaft.length)), true);
}

double resistance(const Ground& ground, const InsertionState& state)
{
  if (state.tip.threshold > 0.0 || state.path.pieces.empty()) return state.tip.threshold;
  return ground.cutting(state.path.pieces.back().tet);
}

void press(const Ground& ground, InsertionState& state, double arc, const needle::Shaft& shaft,
           const Deformed& tissue)
{
  TipState& tip = state.tip;
  const bool was_pressed = tip.pressed;
  const int tet = tip.threshold > 0.0 ? tip.tet : last_tet(state.path);
  tip.pressed = false;
  if (tet < 0 || resistance(ground, state) <= 0.0) return;
  const double tolerance = arc_tolerance(ground.mesh, tet);
  tip.pressed = was_pressed || arc >= state.path.length() - tolerance;
  if (!tip.pressed || was_pressed) return;
  const Vec3& X = state.path.vertex.back();
  const needle::ShaftPoint end = needle::shaft_at(shaft, shaft.length);
  tip.radius = std::max(ground.settings.tip.radius, local_edge(ground.mesh, tet));
  tip.tet = tet;
  tip.hold = tip_support(
      ground.mesh, ground.locator, {X, tet, tip.radius},
      tip.wall ? disc_frame(face_normal(ground.mesh, tet, X), end) : frame_of(end), tip.wall);
  // The needle's end is ahead of the end of its path by what the mesh hides.
  tip.hidden = end.tangent.dot(hidden_motion_at_tip(ground, state, shaft));
  tip.offset = tissue.position(tip.hold) - (tissue.place(X, tet) + tip.hidden * end.tangent);
}

Vec3 lead(const InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue)
{
  if (!state.tip.pressed) return Vec3::Zero();
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const Vec3 closed = tissue.position(state.tip.hold) - state.tip.offset;
  const Vec3 place = tissue.place(state.path.vertex.back(), state.tip.tet);
  return tangent * tangent.dot(place - closed);
}

Vec3 tip_on_way(const Ground& ground, const InsertionState& state, const needle::Shaft& shaft,
                const Deformed& tissue)
{
  Vec3 tip = shaft.tip() + lead(state, shaft, tissue) - hidden_motion_at_tip(ground, state, shaft);
  if (state.tip.pressed)  // the lead has what was hidden when the gap was closed
    tip += state.tip.hidden * needle::shaft_at(shaft, shaft.length).tangent;
  return tip;
}

namespace {

void leave_surface(InsertionState& state)
{
  const int first_id = state.path.first_id;
  state.path = {};
  state.path.first_id = first_id;
  state.phase = Phase::outside;
  state.tip.pressed = false;
}

/// Moves a tip pressed on a surface to the place where its axis meets the surface now. Where there
/// is no such place or nothing resists, the tip leaves the surface. True when the tip stays on it.
bool stand(const Ground& ground, InsertionState& state, const needle::Shaft& shaft,
           const Deformed& tissue)
{
  const double edge = local_edge(ground.mesh, state.tip.tet);
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const Vec3 ahead = shaft.tip() + lead(state, shaft, tissue) + edge * tangent;
  const Vec3 stood = state.path.vertex.back();
  const auto entries = tissue.entries(shaft.x.front(), ahead, ground.body_of_node);
  const auto nearest =
      std::min_element(entries.begin(), entries.end(), [&](const auto& a, const auto& b) {
        return (a.X - stood).squaredNorm() < (b.X - stood).squaredNorm();
      });
  const bool there = nearest != entries.end();
  const int tet = there ? ground.tet_at(nearest->X, nearest->first_tet) : -1;
  if (tet >= 0) touch_surface(ground, state, nearest->X, tet, shaft);
  if (!there || state.tip.threshold <= 0.0) leave_surface(state);
  return state.tip.pressed;
}

/// Reference place of a tip at the end of its path; extrapolated when the tip is not in its body.
Vec3 reference_of(const Ground& ground, const Vec3& tip, const InsertionState& state,
                  const Deformed& tissue)
{
  if (ground.bodies > 1) return reference_in(ground, tissue, tip, state.tip.tet);
  const auto inside = tissue.reference_place(tip, state.path.vertex.back());
  return inside ? inside->X : tissue.reference_place_continued(tip, state.tip.tet);
}

/// The tissue has yielded: the border before the tip is pierced, and the channel grows to the tip.
void go_ahead(const Ground& ground, InsertionState& state, const Vec3& tip,
              const needle::Shaft& shaft, const Deformed& tissue)
{
  const Vec3 X =
      passed_place(ground, state, reference_of(ground, tip, state, tissue), state.tip.tet, shaft);
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  const double hidden = tangent.dot(hidden_motion_at_tip(ground, state, shaft));
  if (state.tip.threshold > 0.0) {
    ++state.tip.punctures;
    state.tip.pierced_arc = state.path.length();
    state.tip.pierced_force = state.tip.threshold;
  }
  grow_to(ground, state, {X, tip, shaft, tissue, state.tip.tet});
  state.phase = Phase::inserted;
  press(ground, state, state.path.length(), shaft, tissue);
  // The gap at the new end of the channel is closed, also in the bevel's direction. A tip stopped
  // by a border is beyond it by the rest of its advance: its gap starts at minus this rest.
  if (state.tip.pressed) {
    state.tip.offset = tissue.position(state.tip.hold) - shaft.tip();
    state.tip.hidden = hidden;
    const Vec3 end = tissue.place(state.path.vertex.back(), state.tip.tet);
    if (state.tip.threshold > 0.0)
      state.tip.offset += std::max(tangent.dot(tip - end), 0.0) * tangent;
  }
  if (ground.along_line())  // the step is over: the tip of the needle is at the end of the path
    return hold_line_behind(ground, state, state.path.length(), shaft.length - state.path.length(),
                            shaft.radius);
  const std::size_t known = state.points.size();
  hold_behind(ground, state, state.path.length(), shaft);
  // The step is over, so the projection of a new point on the shaft gives its needle_arc. Under
  // load this is a little ahead of the value computed from arcs on the path.
  for (std::size_t k = known; k < state.points.size(); ++k) {
    const Site& site = state.path.sites[static_cast<std::size_t>(state.points[k].site)];
    state.points[k].needle_arc = needle::project(shaft, tissue.position(site.anchor)).s;
  }
}

}  // namespace

void settle_tip(const Ground& ground, InsertionState& state, const CouplingReport& report,
                const needle::Shaft& shaft, const Deformed& tissue)
{
  if (report.tip == TipOutcome::holds) return;
  const bool on_surface = state.phase == Phase::contact;
  const Vec3 tangent = needle::shaft_at(shaft, shaft.length).tangent;
  if (on_surface && report.tip == TipOutcome::apart) return leave_surface(state);
  if (on_surface && !stand(ground, state, shaft, tissue)) return;
  if (report.tip == TipOutcome::slides) {
    state.tip.offset = tissue.position(state.tip.hold) - shaft.tip();
    return;
  }
  // On a surface the channel begins where the axis meets it and is as deep as the tip's row
  // advanced. Elsewhere the channel ends at the tip.
  Vec3 tip = tip_on_way(ground, state, shaft, tissue);
  if (on_surface)
    tip = tissue.place(state.path.vertex.back(), state.tip.tet) - report.tip_gap * tangent;
  state.tip.pressed = false;
  if (report.tip == TipOutcome::yields) return go_ahead(ground, state, tip, shaft, tissue);
  const PathRun run = run_at(state.path, state.path.length());
  const double arc = arc_nearest(state.path, run, reference_of(ground, tip, state, tissue));
  state.tip_arc = std::clamp(arc, 0.0, state.path.length());
}

}  // namespace trocar::insertion
