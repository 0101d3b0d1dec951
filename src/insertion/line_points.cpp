#include "insertion/line_points.hpp"

#include <algorithm>
#include <map>

#include "insertion/line_compliance.hpp"

namespace trocar::insertion {

int point_of(const InsertionState& state, int hat)
{
  const auto at =
      std::lower_bound(state.points.begin(), state.points.end(), hat,
                       [](const CouplingPoint& point, int site) { return point.site < site; });
  const bool found = at != state.points.end() && at->site == hat;
  return found ? static_cast<int>(at - state.points.begin()) : -1;
}

core::MatX lengths_of_hats(const mesh::Mesh& mesh, const InsertionState& state)
{
  const auto points = static_cast<Eigen::Index>(state.points.size());
  core::MatX length = core::MatX::Zero(points, static_cast<Eigen::Index>(mesh.volumes.size()));
  for (Eigen::Index k = 0; k < points; ++k) {
    const int node = state.points[static_cast<std::size_t>(k)].site;
    each_station(state.path.line, [&](const Station& station) {
      length(k, mesh.region[static_cast<std::size_t>(station.tet)]) +=
          station.length * hat(state.path.line, node, station.stretch, station.arc);
    });
  }
  return length;
}

Vec3 hidden_motion_at_tip(const Ground& ground, const InsertionState& state,
                          const needle::Shaft& shaft)
{
  Vec3 motion = Vec3::Zero();
  if (!ground.along_line() || state.points.empty()) return motion;
  const TipCompliance hidden = hidden_at_tip(ground, state.path.line, state.tip_arc, shaft.radius);
  for (const CouplingPoint& point : state.points) {
    const needle::ShaftPoint on = needle::shaft_at(shaft, std::min(point.needle_arc, shaft.length));
    motion += hidden.axial[point.site] * point.lambda[2] * on.tangent;
    motion += hidden.lateral[point.site] *
              (point.lambda[0] * on.normal_1 + point.lambda[1] * on.normal_2);
  }
  return motion;
}

Vec3 passed_place(const Ground& ground, const InsertionState& state, const Vec3& X, int tet,
                  const needle::Shaft& shaft)
{
  if (!ground.along_line() || tet < 0) return X;
  const double arc = std::max(state.tip_arc, 0.0);
  const bool begun = state.path.vertex.size() > 1;
  const Vec3 from =
      begun ? place_at(state.path, std::min(arc, state.path.length())) : state.path.vertex.front();
  const double moved = (X - from).norm();
  // The density of the last hat that slipped, at the entry that of the tissue's friction.
  double density = ground.settings.friction[ground.region(tet)].advance.dynamic_limit;
  for (const CouplingPoint& point : state.points) {
    const double held = moments(state.path.line, point.site, 0.0, arc).length;
    if (!point.stuck && held > 0.0) density = point.lambda[2] / held;
  }
  const Line& line = state.path.line;
  const double surface = std::max(line.stretches.empty() ? 0.0 : line.stretches.back().begin,
                                  run_at(state.path, arc).begin);
  const double passed = length_passed(
      ground, {from, tet, std::max(arc - surface, 0.0), moved, density, shaft.radius});
  return moved > 0.0 ? Vec3(from + passed / moved * (X - from)) : X;
}

namespace {

/// Mean places of the tissue held by every hat, for output, and the points of all hats.
void place_hats(const InsertionState& before, InsertionState& state)
{
  Path& path = state.path;
  for (int k = 0; k < path.line.hats(); ++k) {
    const HatMoments held = moments(path.line, k, 0.0, state.tip_arc);
    const auto at = static_cast<std::size_t>(k);
    const LineNode& node = path.line.nodes[at];
    const Stretch& stretch = path.line.stretches[static_cast<std::size_t>(node.stretch)];
    if (path.sites.size() <= at) path.sites.push_back({node.arc, stretch.tet, {}});
    const bool complete = at + 1 < path.line.nodes.size() &&
                          path.line.nodes[at + 1].arc <= std::min(before.tip_arc, state.tip_arc);
    if (!(held.length > 0.0) || (complete && !path.sites[at].anchor.node.empty())) continue;
    std::map<int, double> nodes;
    each_station(path.line, [&](const Station& station) {
      const double w =
          hat(path.line, k, station.stretch, station.arc) * station.length / held.length;
      if (w == 0.0) return;
      for (std::size_t a = 0; a < station.ring.node.size(); ++a)
        nodes[station.ring.node[a]] += w * station.ring.weight[static_cast<Eigen::Index>(a)];
    });
    path.sites[at] = {held.arc / held.length, stretch.tet, constraint::anchor_of(nodes)};
  }
}

/// Stretch of the hidden compliance [m] under the forces of the last step, spread over what every
/// hat holds now: with it a piece newly passed is as loaded as what it joins.
core::VecX born_stretch(const Ground& ground, const InsertionState& before,
                        const InsertionState& state, double radius)
{
  const int hats = state.path.line.hats();
  core::VecX force = core::VecX::Zero(hats);
  double density = 0.0;
  for (int k = 0; k < hats; ++k) {
    const int point = point_of(before, k);
    const double held = moments(state.path.line, k, 0.0, before.tip_arc).length;
    if (point >= 0 && held > 0.0 && !before.points[static_cast<std::size_t>(point)].stuck)
      density = before.points[static_cast<std::size_t>(point)].lambda[2] / held;
    force[k] = density * moments(state.path.line, k, 0.0, state.tip_arc).length;
  }
  return hidden_compliance(ground, state.path.line, state.tip_arc, radius).axial * force;
}

}  // namespace

void hold_line_behind(const Ground& ground, InsertionState& state, double arc, double needle_arc,
                      double radius)
{
  const InsertionState before = state;
  Line& line = state.path.line;
  extend(ground, state.path, line, radius);
  take_stations(ground, state.path, line, arc, radius);
  state.tip_arc = arc;
  place_hats(before, state);
  const double old_arc = std::max(before.tip_arc, 0.0);
  const bool grows = arc > old_arc;
  core::VecX stretch = core::VecX::Zero(line.hats());
  if (grows && !before.points.empty()) stretch = born_stretch(ground, before, state, radius);
  state.points.clear();
  for (int k = 0; k < line.hats(); ++k) {
    const HatMoments now = moments(line, k, 0.0, arc), then = moments(line, k, 0.0, old_arc);
    if (!(now.length > 0.0)) continue;
    const int was = point_of(before, k);
    const bool known = was >= 0 && then.length > 0.0;
    CouplingPoint point;
    point.stuck = false;
    if (known) point = before.points[static_cast<std::size_t>(was)];
    point.site = k;
    const double mean_now = now.arc / now.length;
    if (!grows && known) {
      // What stays keeps its place on the needle relative to the path.
      point.needle_arc += mean_now - then.arc / then.length;
    } else {
      // What is newly passed counts as having slipped for the whole step.
      const double born = now.length - then.length;
      const double newly = born * (needle_arc + stretch[k]) + (now.arc - then.arc);
      point.needle_arc = (then.length * (known ? point.needle_arc : 0.0) + newly) / now.length;
    }
    state.points.push_back(point);
  }
}

}  // namespace trocar::insertion
