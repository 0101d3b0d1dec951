#include <algorithm>
#include <cmath>

#include "insertion/insertion.hpp"

// The rows that couple one needle and the tissue in a step, and what is made of their multipliers.
namespace trocar::insertion {
namespace {

/// How far along its way from the first point a tip has passed the last place that may hold the
/// needle: whole numbers of half edges, and below one its half, quarter, eighth.
double passed_part(double way, double half)
{
  constexpr double least = 1.0 / 8.0;
  const double halves = way / half + relative_tolerance;
  if (halves >= 1.0) return half * std::floor(halves);
  for (double part = 0.5; part >= least; part *= 0.5)
    if (halves >= part) return half * part;
  return 0.0;
}

}  // namespace

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

RadiusCorrection::Softness Insertion::radius_softness(const Site& site, int body,
                                                      double length) const
{
  if (!settings_.radius_correction) return {};
  return settings_.radius_correction->at(body, mesh_->region[static_cast<std::size_t>(site.tet)],
                                         local_edge(*mesh_, site.tet), length);
}

void Insertion::add_axial_rows(const CouplingPoint& point, const Friction& friction, double h,
                               double radius_softness, constraint::Row row, PointRows& mine,
                               constraint::Set& set) const
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
  if (!(radius_softness > 0.0)) return;
  // Both laws push the same piece of shaft: its way through the tissue is that of their sum.
  for (int row_of_law : {mine.viscous, mine.axial})
    if (row_of_law >= 0) set.couplings().push_back({row_of_law, row_of_law, radius_softness});
  if (mine.viscous >= 0 && mine.axial >= 0)
    set.couplings().push_back({mine.viscous, mine.axial, radius_softness});
}

/// Which points hold the shaft laterally: all, but when they stand closer than `merge` local edges
/// along a path that is not straight, the first of all and the last one of each tet that the tip
/// has left, which is where crossings would be. In a tet the displacement is linear, so that more
/// points on a curve contradict each other by little, and fight it out with huge forces.
std::vector<bool> Insertion::lateral_points(const InsertionState& state) const
{
  const std::size_t count = state.points.size();
  const PlacementSettings& placement = settings_.placement;
  std::vector<bool> lateral(count, true);
  if (placement.placement == Placement::crossings || straight(state.path)) return lateral;
  for (std::size_t k = 1; k < count; ++k) {
    const int tet = state.path.sites[k].tet;
    const double edge = local_edge(*mesh_, tet);
    const bool last_of_tet = k + 1 < count && tet != state.path.sites[k + 1].tet;
    lateral[k] = last_of_tet || placement.spacing >= placement.merge * edge;
  }
  return lateral;
}

PointRows Insertion::add_point_rows(const CouplingPoint& point, bool lateral, const Path& path,
                                    const Friction& friction, double length, double held,
                                    const needle::Shaft& shaft, const Deformed& tissue, int body,
                                    double h, constraint::Set& set) const
{
  PointRows mine;
  constraint::Row row;
  const Site& site = path.sites[static_cast<std::size_t>(point.site)];
  row.anchor = site.anchor;
  row.body = body;
  row.point = set.size();
  const Vec3 p = tissue.position(row.anchor);
  const needle::ShaftPoint on_shaft = needle::project(shaft, p);
  const auto aim = [&](const Vec3& direction, double start) {
    row.direction = direction;
    row.gap = direction.dot(p - on_shaft.x);
    row.lever = needle::lever(shaft, on_shaft.s, direction);
    row.start = start;
  };
  if (lateral) {
    row.softness = radius_softness(site, body, held).lateral;
    mine.first = set.size();
    aim(on_shaft.normal_1, point.lambda[0]);
    set.add(row);
    aim(on_shaft.normal_2, point.lambda[1]);
    set.add(row);
  }
  row.softness = 0.0;
  aim(on_shaft.tangent, point.lambda[2]);
  row.gap = mine.slid = on_shaft.s - point.needle_arc;
  add_axial_rows(point, friction, h, radius_softness(site, body, length).axial, row, mine, set);
  return mine;
}

/// A needle that one point alone holds could turn about it, until its tip meets the next place for
/// one. Until then the last half edge that the tip has passed, or within the first one a part of
/// it, holds it as well: a material place, that does not go along with the tip. Returns the first
/// of two rows; -1: none is passed.
int Insertion::add_lever_rows(const InsertionState& state, const needle::Shaft& shaft,
                              const Deformed& tissue, int body, constraint::Set& set) const
{
  const Site& held = state.path.sites[static_cast<std::size_t>(state.points.front().site)];
  const double half = 0.5 * local_edge(*mesh_, held.tet);
  const double passed = passed_part(state.tip_arc - held.arc, half);
  if (passed == 0.0) return -1;
  const std::optional<Site> tip = site_at(state.path, *mesh_, held.arc + passed);
  if (!tip || tip->arc - held.arc < 0.5 * std::min(passed, half))
    return -1;  // the way is mostly through a void
  const Vec3 p = tissue.position(tip->anchor);
  const needle::ShaftPoint on_shaft = needle::project(shaft, p);
  constraint::Row row;
  row.anchor = tip->anchor;
  row.body = body;
  row.point = set.size();
  row.softness = radius_softness(*tip, body, 0.5 * (tip->arc - held.arc)).lateral;
  for (const Vec3& direction : {on_shaft.normal_1, on_shaft.normal_2}) {
    row.direction = direction;
    row.gap = direction.dot(p - on_shaft.x);
    row.lever = needle::lever(shaft, on_shaft.s, direction);
    set.add(row);
  }
  return set.size() - 2;
}

CouplingRows Insertion::add_rows(const InsertionState& state, const needle::Shaft& shaft,
                                 const Deformed& tissue, int body, double h,
                                 constraint::Set& set) const
{
  CouplingRows rows;
  const core::MatX tributary = tributary_lengths(state);
  const std::vector<bool> lateral = lateral_points(state);
  double held = 0.0;  // of the path by the next point that holds the shaft laterally [m]
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    const double own = tributary.row(static_cast<Eigen::Index>(k)).sum();
    held += own;
    rows.points.push_back(add_point_rows(state.points[k], lateral[k], state.path,
                                         friction_of(state, tributary, k), own, held, shaft, tissue,
                                         body, h, set));
    if (lateral[k]) held = 0.0;
  }
  if (std::count(lateral.begin(), lateral.end(), true) == 1)
    rows.lever = add_lever_rows(state, shaft, tissue, body, set);
  if (state.tip.pressed)
    rows.tip = add_tip_rows(state.tip, state.phase == Phase::contact, resistance(state),
                            settings_.tip.friction, shaft, tissue, body, set);
  return rows;
}

void Insertion::accept_point(CouplingPoint& point, const PointRows& rows,
                             const law::Multipliers& multipliers, CouplingReport& report) const
{
  point.lambda.setZero();
  if (rows.first >= 0) point.lambda.head<2>() = multipliers.lambda.segment<2>(rows.first);
  for (int row : {rows.axial, rows.viscous}) {
    if (row < 0) continue;
    point.lambda[2] += multipliers.lambda[row];
    report.friction_work += multipliers.lambda[row] * multipliers.delta[row];
  }
  report.shaft_friction += point.lambda[2];
  const int axial = std::max(rows.axial, rows.viscous);  // both see the same slip
  // What nothing holds follows the shaft.
  const double slip = axial < 0 ? rows.slid : multipliers.delta[axial];
  // Inside its box a point sticks, however loosely an unfinished iteration closed its gap.
  const bool inside = rows.axial >= 0 && rows.bound > 0.0 &&
                      std::abs(multipliers.lambda[rows.axial]) < rows.bound * (1.0 - 1e-9);
  point.stuck = inside || std::abs(slip) <= settings_.stick_tolerance;
  if (!point.stuck) point.needle_arc += slip;
}

CouplingReport Insertion::accept(InsertionState& state, const CouplingRows& rows,
                                 const law::Multipliers& multipliers) const
{
  CouplingReport report;
  for (std::size_t k = 0; k < rows.points.size(); ++k)
    accept_point(state.points[k], rows.points[k], multipliers, report);
  if (rows.tip.axial < 0) return report;
  report.tip = accept_tip(state.tip, rows.tip, multipliers, settings_.stick_tolerance);
  report.tip_force = state.tip.lambda[2];
  report.tip_gap = multipliers.delta[rows.tip.axial];
  report.cutting_work = report.tip_force * report.tip_gap;
  if (rows.tip.lateral >= 0)
    report.friction_work += multipliers.lambda.segment<2>(rows.tip.lateral)
                                .dot(multipliers.delta.segment<2>(rows.tip.lateral));
  return report;
}

}  // namespace trocar::insertion
