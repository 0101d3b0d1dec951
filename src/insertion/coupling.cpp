#include "insertion/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "insertion/line_points.hpp"
#include "insertion/line_rows.hpp"
#include "insertion/tip_events.hpp"

// Makes the rows that couple one needle to the tissue.
namespace trocar::insertion {

core::MatX tributary_lengths(const mesh::Mesh& mesh, const InsertionState& state)
{
  const auto points = static_cast<Eigen::Index>(state.points.size());
  core::MatX length = core::MatX::Zero(points, static_cast<Eigen::Index>(mesh.volumes.size()));
  if (points == 0) return length;
  if (!state.path.line.nodes.empty()) return lengths_of_hats(mesh, state);
  const auto arc_of = [&](Eigen::Index k) {
    const int site = state.points[static_cast<std::size_t>(k)].site;
    return state.path.sites[static_cast<std::size_t>(site)].arc;
  };
  for (const Piece& piece : state.path.pieces) {
    if (piece.tet < 0) continue;
    const int region = mesh.region[static_cast<std::size_t>(piece.tet)];
    double at = piece.begin;
    const double end = std::min(piece.end, state.tip_arc);
    for (Eigen::Index k = 0; k < points && at < end; ++k) {
      // The cell of point k ends half-way to the next point, the cell of the last point at the tip.
      const double border = k + 1 < points ? 0.5 * (arc_of(k) + arc_of(k + 1)) : end;
      if (border <= at) continue;
      length(k, region) += std::min(border, end) - at;
      at = std::min(border, end);
    }
  }
  return length;
}

namespace {

/// A coupling point with what its rows need. Its piece is the part of the path nearest to it.
struct PointOnPath
{
  const CouplingPoint& point;
  const Site& site;
  Friction friction;     ///< limits [N] and dashpot [N s/m] of the whole piece
  double length = 0.0;   ///< length of the piece that lies in tissue [m]
  bool lateral = false;  ///< the point holds the shaft laterally
  double held = 0.0;     ///< length of path in tissue since the last lateral point [m]
};

/// Friction of one point: for each tissue, its friction per length times its `lengths` [m], summed.
Friction friction_of(const Ground& ground, bool withdrawing, const core::VecX& lengths)
{
  Friction sum;
  for (std::size_t region = 0; region < ground.settings.friction.size(); ++region) {
    const double length = lengths[static_cast<Eigen::Index>(region)];
    const TissueFriction& both = ground.settings.friction[region];
    const Friction& law = withdrawing ? both.withdraw : both.advance;
    sum.static_limit += length * law.static_limit;
    sum.dynamic_limit += length * law.dynamic_limit;
    sum.viscous += length * law.viscous;
  }
  return sum;
}

/// Which points hold the shaft laterally. All do, unless they stand closer than `merge` local edges
/// on a path that is not straight. Then only the very first point does, and the last point of each
/// tet that the tip has left, near the face crossing. The displacement is linear within a tet, so
/// more points on a curved path would contradict each other slightly and cause huge forces.
std::vector<bool> lateral_points(const Ground& ground, const InsertionState& state)
{
  const std::size_t count = state.points.size();
  const PlacementSettings& placement = ground.settings.placement;
  std::vector<bool> lateral(count, true);
  if (placement.placement == Placement::crossings || straight(state.path)) return lateral;
  for (std::size_t k = 1; k < count; ++k) {
    const int tet = state.path.sites[k].tet;
    const double edge = local_edge(ground.mesh, tet);
    const bool last_of_tet = k + 1 < count && tet != state.path.sites[k + 1].tet;
    lateral[k] = last_of_tet || placement.spacing >= placement.merge * edge;
  }
  return lateral;
}

std::vector<PointOnPath> points_on_path(const Ground& ground, const InsertionState& state)
{
  const core::MatX tributary = tributary_lengths(ground.mesh, state);
  const std::vector<bool> lateral = lateral_points(ground, state);
  std::vector<PointOnPath> points;
  double held = 0.0;
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    const core::VecX lengths = tributary.row(static_cast<Eigen::Index>(k));
    const CouplingPoint& point = state.points[k];
    held += lengths.sum();
    points.push_back({point, state.path.sites[static_cast<std::size_t>(point.site)],
                      friction_of(ground, state.withdrawing, lengths), lengths.sum(), lateral[k],
                      held});
    if (lateral[k]) held = 0.0;
  }
  return points;
}

RadiusCorrection::Compliance radius_compliance(const Ground& ground, const Site& site, int body,
                                               double length)
{
  if (!ground.settings.radius_correction) return {};
  return ground.settings.radius_correction->at(body, ground.material(site.tet),
                                               local_edge(ground.mesh, site.tet), length);
}

/// A material place of the tissue and its projection on the shaft.
struct Hold
{
  Hold(const constraint::Anchor& anchor_of, const Iterate& at_iterate)
      : anchor(anchor_of),
        at(at_iterate),
        x(at.tissue.position(anchor)),
        on_shaft(needle::project(at.shaft, x))
  {
  }

  /// Row between tissue and shaft in `direction`; the gap is their distance in it.
  constraint::Row row(const Vec3& direction) const
  {
    auto made = constraint::Row::between({anchor, direction}, at.body,
                                         needle::jacobian(at.shaft, on_shaft.s, direction));
    made.gap = direction.dot(x - on_shaft.x);
    return made;
  }

  const constraint::Anchor& anchor;
  const Iterate& at;
  Vec3 x;
  needle::ShaftPoint on_shaft;
};

/// Adds two rows normal to the shaft and returns the first.
int add_lateral_rows(const Hold& hold, double compliance, const Vec3& start, int point,
                     constraint::Set& set)
{
  const int first = set.size();
  for (int k : {0, 1}) {
    constraint::Row row = hold.row(k == 0 ? hold.on_shaft.normal_1 : hold.on_shaft.normal_2);
    row.compliance = compliance;
    row.start = start[k];
    set.add(std::move(row), law::Law::zero(), point);
  }
  return first;
}

/// Lets the tissue next to the shaft yield to the sum of the forces of both axial rows, which load
/// the same piece of shaft. `compliance`: of this tissue [m/N].
void soften(const PointRows& mine, double compliance, constraint::Set& set)
{
  if (!(compliance > 0.0)) return;
  for (int row_of_law : {mine.viscous, mine.axial})
    if (row_of_law >= 0) set.couplings().push_back({row_of_law, row_of_law, compliance});
  if (mine.viscous >= 0 && mine.axial >= 0)
    set.couplings().push_back({mine.viscous, mine.axial, compliance});
}

PointRows add_point_rows(const Ground& ground, const PointOnPath& one, const Iterate& at,
                         constraint::Set& set)
{
  PointRows mine;
  mine.from = one.point.site;
  mine.point = set.next_point();
  const Hold hold(one.site.anchor, at);
  if (one.lateral)
    mine.first =
        add_lateral_rows(hold, radius_compliance(ground, one.site, at.body, one.held).lateral,
                         one.point.lambda, mine.point, set);
  constraint::Row row = hold.row(hold.on_shaft.tangent);
  row.start = one.point.lambda[2];
  row.gap = mine.slid = hold.on_shaft.s - one.point.needle_arc;
  const double eta = ground.settings.eta;
  if (eta > 0.0) {
    row.relative_compliance = (1.0 - eta) / eta;
    mine.axial = set.add(std::move(row), law::Law::zero(), mine.point);
    return mine;
  }
  const Friction& friction = one.friction;
  mine.bound = one.point.stuck ? friction.static_limit : friction.dynamic_limit;
  const double compliance = radius_compliance(ground, one.site, at.body, one.length).axial;
  add_friction_rows(friction.viscous > 0.0 ? at.h / friction.viscous : 0.0, std::move(row), mine,
                    set);
  soften(mine, compliance, set);
  return mine;
}

/// Distance from the first point to the place of the lever rows [m]: the largest multiple of `half`
/// (half a local edge) that the tip has passed, else 1/2, 1/4 or 1/8 of `half`; 0: none of these.
/// `way`: distance from the first point to the tip [m].
double passed_part(double way, double half)
{
  constexpr double least = 1.0 / 8.0;
  const double halves = way / half + relative_tolerance;
  if (halves >= 1.0) return half * std::floor(halves);
  for (double part = 0.5; part >= least; part *= 0.5)
    if (halves >= part) return half * part;
  return 0.0;
}

/// A needle held by a single point would turn about it. Until the tip meets the next site, two
/// lateral rows hold the shaft at a second place: see `passed_part`. This place is material: it
/// does not move along with the tip. A tet resists turning as if the two places were half a local
/// edge apart, however near they are. Nearer places therefore get a compliance (docs/theory.md
/// section 4). Returns the first of the two rows, or -1 when the tip has passed no such place.
int add_lever_rows(const Ground& ground, const InsertionState& state, const Iterate& at,
                   constraint::Set& set)
{
  const Site& held = state.path.sites[static_cast<std::size_t>(state.points.front().site)];
  const double half = 0.5 * local_edge(ground.mesh, held.tet);
  const double passed = passed_part(state.tip_arc - held.arc, half);
  if (passed == 0.0) return -1;
  const std::optional<Site> tip = site_at(state.path, ground.mesh, held.arc + passed);
  if (!tip || tip->arc - held.arc < 0.5 * std::min(passed, half))
    return -1;  // most of the way lies in a void
  const double compliance =
      radius_compliance(ground, *tip, at.body, 0.5 * (tip->arc - held.arc)).lateral +
      lever_compliance(ground.material(tip->tet), passed, half);
  return add_lateral_rows(Hold(tip->anchor, at), compliance, Vec3::Zero(), set.next_point(), set);
}

/// Rows of single points on the path.
void add_rows_of_points(const Ground& ground, const InsertionState& state, const Iterate& at,
                        CouplingRows& rows, constraint::Set& set)
{
  int lateral = 0;
  for (const PointOnPath& one : points_on_path(ground, state)) {
    rows.points.push_back(add_point_rows(ground, one, at, set));
    lateral += one.lateral ? 1 : 0;
  }
  if (lateral == 1) rows.lever = add_lever_rows(ground, state, at, set);
}

}  // namespace

void add_friction_rows(double dashpot, constraint::Row row, PointRows& rows, constraint::Set& set)
{
  if (dashpot > 0.0) {
    row.compliance = dashpot;
    rows.viscous = set.add(row, law::Law::zero(), rows.point);
    row.compliance = 0.0;
  }
  if (rows.bound > 0.0) rows.axial = set.add(row, law::Law::box(rows.bound), rows.point);
}

CouplingRows add_rows(const Ground& ground, const InsertionState& state, const Iterate& at,
                      constraint::Set& set)
{
  CouplingRows rows;
  if (ground.along_line())
    rows.points = add_line_rows(ground, state, at, set);
  else
    add_rows_of_points(ground, state, at, rows, set);
  if (state.tip.pressed) {
    const TipLaw law{state.phase == Phase::contact, resistance(ground, state),
                     ground.settings.tip.friction};
    rows.tip = add_tip_rows(state.tip, law, at, set);
  }
  return rows;
}

}  // namespace trocar::insertion
