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

}  // namespace

Insertion::Insertion(const mesh::Mesh& mesh, const mesh::Locator& locator,
                     InsertionSettings settings)
    : mesh_(&mesh), locator_(&locator), settings_(std::move(settings))
{
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
  add_points_behind(state, state.path.length(), {});
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
  CouplingPoint born;
  born.needle_arc = predicted.length;
  born.stuck = false;
  if (old.path.empty()) return enter(old, predicted, tissue, born);

  const Vec3& tip = predicted.tip();
  const auto inside = tissue.reference_place(tip, old.path.vertex.back());
  if (old.phase == Phase::withdrawn) {
    if (!inside) return old;
    // Beside the old channel the tip cuts a new one; the old one is then forgotten.
    const double beside = distance(old.path, *inside);
    if (beside > 0.3 * arc_tolerance(*mesh_, first_tet(old.path)) / relative_tolerance)
      return enter(old, predicted, tissue, born);
  }
  // Beyond its tets the map of the nearest end is continued: the tip may be out at either side.
  const bool behind = old.tip_arc <= 0.5 * old.path.length();
  const int end_tet = behind ? first_tet(old.path) : last_tet(old.path);
  const Vec3 X = inside ? *inside : tissue.reference_place_continued(tip, end_tet);
  InsertionState next = old;
  double arc = arc_nearest(next.path, X);
  const double tolerance = arc_tolerance(*mesh_, end_tet);
  if (arc > next.path.length() + 1e-3 * tolerance) {
    grow(next.path, X, *mesh_, *locator_, settings_.placement);
    arc = next.path.length();
  }
  // A tip outside the tissue in front of the entry has left the channel, whatever the map says.
  if (!inside && behind && arc > 0.0 && arc < tolerance) arc = 0.0;
  next.phase = arc > 0.0 ? Phase::inserted : Phase::withdrawn;
  if (std::abs(arc - old.tip_arc) > tolerance) next.withdrawing = arc < old.tip_arc;
  drop_points_ahead(next, arc);
  add_points_behind(next, arc, born);
  return next;
}

InsertionState Insertion::enter(const InsertionState& old, const needle::Shaft& predicted,
                                const Deformed& tissue, const CouplingPoint& born) const
{
  const auto entry = tissue.entry(predicted.x.front(), predicted.tip());
  const auto X = entry ? tissue.reference_place(predicted.tip(), *entry) : std::nullopt;
  if (!X) return old;
  InsertionState next;
  next.path.first_id = old.path.first_id + static_cast<int>(old.path.sites.size());
  grow(next.path, *entry, *mesh_, *locator_, settings_.placement);
  grow(next.path, *X, *mesh_, *locator_, settings_.placement);
  if (first_tet(next.path) < 0) return old;
  next.phase = Phase::inserted;
  add_points_behind(next, next.path.length(), born);
  return next;
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

void Insertion::add_points_behind(InsertionState& state, double arc,
                                  const CouplingPoint& born) const
{
  const double old_arc = std::max(state.tip_arc, 0.0);
  state.tip_arc = arc;
  while (state.points.size() < state.path.sites.size() && passed(state, state.points.size(), arc)) {
    CouplingPoint point = born;
    point.site = static_cast<int>(state.points.size());
    // The tip passed it within the step; it counts as having slipped the whole step, so that its
    // friction is there at once and the force has no dent where points are born.
    const double site_arc = state.path.sites[state.points.size()].arc;
    point.needle_arc += std::max(site_arc - old_arc, 0.0);
    state.points.push_back(point);
  }
}

double Insertion::depth(const InsertionState& state) const
{
  return state.path.empty() ? 0.0 : tissue_length(state.path, state.tip_arc);
}

core::MatX Insertion::tributary_lengths(const InsertionState& state) const
{
  const auto points = static_cast<Eigen::Index>(state.points.size());
  core::MatX length = core::MatX::Zero(points, static_cast<Eigen::Index>(mesh_->volumes.size()));
  if (points == 0) return length;
  const auto arc_of = [&](Eigen::Index k) {
    const int site = state.points[static_cast<std::size_t>(k)].site;
    return state.path.sites[static_cast<std::size_t>(site)].arc;
  };
  for (const Piece& piece : state.path.pieces) {
    if (piece.tet < 0) continue;
    const int region = mesh_->region[static_cast<std::size_t>(piece.tet)];
    double at = piece.begin;
    const double end = std::min(piece.end, state.tip_arc);
    for (Eigen::Index k = 0; k < points && at < end; ++k) {
      // The cell of point k ends half-way to the next one; the last one's at the tip.
      const double border = k + 1 < points ? 0.5 * (arc_of(k) + arc_of(k + 1)) : end;
      if (border <= at) continue;
      length(k, region) += std::min(border, end) - at;
      at = std::min(border, end);
    }
  }
  return length;
}

/// Limits [N] and dashpot [N s/m] of one point: the laws of the tissues its piece of path is in.
Friction Insertion::friction_of(const InsertionState& state, const core::MatX& tributary,
                                std::size_t point) const
{
  Friction sum;
  for (std::size_t region = 0; region < settings_.friction.size(); ++region) {
    const double length =
        tributary(static_cast<Eigen::Index>(point), static_cast<Eigen::Index>(region));
    const TissueFriction& both = settings_.friction[region];
    const Friction& law = state.withdrawing ? both.withdraw : both.advance;
    sum.static_limit += length * law.static_limit;
    sum.dynamic_limit += length * law.dynamic_limit;
    sum.viscous += length * law.viscous;
  }
  return sum;
}

void Insertion::add_axial_rows(const CouplingPoint& point, const Friction& friction, double h,
                               constraint::Row row, PointRows& mine, constraint::Set& set) const
{
  const auto add = [&] {
    set.add(row);
    return set.size() - 1;
  };
  if (settings_.eta > 0.0) {
    row.relative_softness = (1.0 - settings_.eta) / settings_.eta;
    mine.axial = add();
    return;
  }
  if (h > 0.0 && friction.viscous > 0.0) {
    row.softness = h / friction.viscous;
    mine.viscous = add();
    row.softness = 0.0;
  }
  mine.bound = point.stuck ? friction.static_limit : friction.dynamic_limit;
  if (mine.bound > 0.0) {
    row.kind = law::RowKind::box;
    row.bound = mine.bound;
    mine.axial = add();
  }
}

std::vector<PointRows> Insertion::add_rows(const InsertionState& state, const needle::Shaft& shaft,
                                           const Deformed& tissue, int body, double h,
                                           constraint::Set& set) const
{
  std::vector<PointRows> rows;
  const core::MatX tributary = tributary_lengths(state);
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    const CouplingPoint& point = state.points[k];
    PointRows mine;
    mine.first = set.size();
    constraint::Row row;
    row.anchor = state.path.sites[static_cast<std::size_t>(point.site)].anchor;
    row.body = body;
    row.point = mine.first;
    const Vec3 p = tissue.position(row.anchor);
    const needle::ShaftPoint on_shaft = needle::project(shaft, p);
    const auto aim = [&](const Vec3& direction, double start) {
      row.direction = direction;
      row.gap = direction.dot(p - on_shaft.x);
      row.lever = needle::lever(shaft, on_shaft.s, direction);
      row.start = start;
    };
    aim(on_shaft.normal_1, point.lambda[0]);
    set.add(row);
    aim(on_shaft.normal_2, point.lambda[1]);
    set.add(row);
    aim(on_shaft.tangent, point.lambda[2]);
    row.gap = mine.slid = on_shaft.s - point.needle_arc;
    add_axial_rows(point, friction_of(state, tributary, k), h, row, mine, set);
    rows.push_back(mine);
  }
  return rows;
}

CouplingReport Insertion::accept(InsertionState& state, const std::vector<PointRows>& rows,
                                 const law::Multipliers& multipliers) const
{
  CouplingReport report;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CouplingPoint& point = state.points[k];
    point.lambda.setZero();
    point.lambda.head<2>() = multipliers.lambda.segment<2>(rows[k].first);
    for (int row : {rows[k].axial, rows[k].viscous}) {
      if (row < 0) continue;
      point.lambda[2] += multipliers.lambda[row];
      report.friction_work += multipliers.lambda[row] * multipliers.delta[row];
    }
    report.shaft_friction += point.lambda[2];
    const int axial = std::max(rows[k].axial, rows[k].viscous);  // both see the same slip
    // What nothing holds follows the shaft.
    const double slip = axial < 0 ? rows[k].slid : multipliers.delta[axial];
    // Inside its box a point sticks, however loosely an unfinished iteration closed its gap.
    const bool inside = rows[k].axial >= 0 && rows[k].bound > 0.0 &&
                        std::abs(multipliers.lambda[rows[k].axial]) < rows[k].bound * (1.0 - 1e-9);
    point.stuck = inside || std::abs(slip) <= settings_.stick_tolerance;
    if (!point.stuck) point.needle_arc += slip;
  }
  return report;
}

}  // namespace trocar::insertion
