#include "insertion/line_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "insertion/line_compliance.hpp"
#include "insertion/line_points.hpp"

namespace trocar::insertion {
namespace {

/// A station in the present geometry and its nearest point on the shaft.
struct Place
{
  const Station& station;
  Vec3 x;
  needle::ShaftPoint on_shaft;
};

/// The hats of a group, joined: weights of the stations (sum 1) and means over them.
struct Held
{
  HatGroup group;
  std::vector<std::pair<const Place*, double>> weight;
  double length = 0.0;      ///< ∫ φ ds [m]
  constraint::Anchor mean;  ///< weights of the tissue's nodes
  needle::ShaftPoint on_shaft;
  std::vector<double> share;  ///< of every hat in the length
  std::vector<double> s;      ///< mean place on the shaft of every hat [m]
};

std::vector<Place> places(const Line& line, const Iterate& at)
{
  std::vector<Place> found;
  each_station(line, [&](const Station& station) {
    const Vec3 x = at.tissue.position(station.ring);
    found.push_back({station, x, needle::project(at.shaft, x)});
  });
  return found;
}

Held held_by(const InsertionState& state, const HatGroup& group, const std::vector<Place>& places,
             const needle::Shaft& shaft)
{
  const Line& line = state.path.line;
  Held held{group, {}, 0.0, {}, {}, {}, {}};
  for (int k = group.first; k < group.first + group.count; ++k)
    held.share.push_back(moments(line, k, 0.0, state.tip_arc).length);
  for (double share : held.share) held.length += share;
  held.s.assign(held.share.size(), 0.0);
  std::map<int, double> nodes;
  double s = 0.0;
  for (const Place& place : places) {
    double phi = 0.0;
    for (std::size_t i = 0; i < held.share.size(); ++i) {
      const double of_hat =
          hat(line, group.first + static_cast<int>(i), place.station.stretch, place.station.arc);
      held.s[i] += of_hat * place.station.length / held.share[i] * place.on_shaft.s;
      phi += of_hat;
    }
    if (phi == 0.0) continue;
    const double w = phi * place.station.length / held.length;
    held.weight.emplace_back(&place, w);
    s += w * place.on_shaft.s;
    const constraint::Anchor& ring = place.station.ring;
    for (std::size_t a = 0; a < ring.node.size(); ++a)
      nodes[ring.node[a]] += w * ring.weight[static_cast<Eigen::Index>(a)];
  }
  for (double& share : held.share) share /= held.length;
  held.mean = constraint::anchor_of(nodes);
  held.on_shaft = needle::shaft_at(shaft, s);
  return held;
}

/// Row between the mean of the tissue and that of the shaft in `direction`; the gap is their
/// distance in it.
constraint::Row row_of(const Held& held, const Vec3& direction, const Iterate& at)
{
  std::map<int, double> on_body;
  double gap = 0.0;
  for (const auto& [place, w] : held.weight) {
    gap += w * direction.dot(place->x - place->on_shaft.x);
    for (const auto& [dof, c] : needle::jacobian(at.shaft, place->on_shaft.s, direction))
      on_body[dof] += w * c;
  }
  auto row =
      constraint::Row::between({held.mean, direction}, at.body, {on_body.begin(), on_body.end()});
  row.gap = gap;
  return row;
}

/// What the points of a group are together: the sum of their forces, the mean by length of where
/// they stick on the needle. The first decides whether it sticks.
CouplingPoint joined(const InsertionState& state, const Held& held, int from)
{
  CouplingPoint all = state.points[static_cast<std::size_t>(from)];
  all.needle_arc = 0.0;
  all.lambda.setZero();
  for (std::size_t i = 0; i < held.share.size(); ++i) {
    const CouplingPoint& point = state.points[static_cast<std::size_t>(from) + i];
    all.needle_arc += held.share[i] * point.needle_arc;
    all.lambda += point.lambda;
  }
  return all;
}

const Friction& friction_along(const Ground& ground, const InsertionState& state, int node)
{
  const Line& line = state.path.line;
  const int stretch = line.nodes[static_cast<std::size_t>(node)].stretch;
  const int tet = line.stretches[static_cast<std::size_t>(stretch)].tet;
  const TissueFriction& both = ground.settings.friction[ground.region(tet)];
  return state.withdrawing ? both.withdraw : both.advance;
}

PointRows add_rows_of(const Ground& ground, const InsertionState& state, const Held& held,
                      const Iterate& at, constraint::Set& set)
{
  PointRows mine;
  mine.point = set.next_point();
  mine.from = point_of(state, held.group.first);
  mine.share = held.share;
  const CouplingPoint together = joined(state, held, mine.from);
  const std::array<Vec3, 2> across{held.on_shaft.normal_1, held.on_shaft.normal_2};
  mine.first = set.size();
  for (int k : {0, 1}) {
    constraint::Row row = row_of(held, across[static_cast<std::size_t>(k)], at);
    row.start = together.lambda[k];
    set.add(std::move(row), law::Law::zero(), mine.point);
  }
  constraint::Row row = row_of(held, held.on_shaft.tangent, at);
  row.start = together.lambda[2];
  row.gap = mine.slid = held.on_shaft.s - together.needle_arc;
  mine.apart.clear();
  for (std::size_t i = 0; i < held.s.size(); ++i) {
    const double arc = state.points[static_cast<std::size_t>(mine.from) + i].needle_arc;
    mine.apart.push_back(held.s.size() > 1 ? held.s[i] - arc - mine.slid : 0.0);
  }
  if (const double eta = ground.settings.eta; eta > 0.0) {
    row.relative_compliance = (1.0 - eta) / eta;
    mine.axial = set.add(std::move(row), law::Law::zero(), mine.point);
    return mine;
  }
  const Friction& friction = friction_along(ground, state, held.group.first);
  mine.bound = held.length * (together.stuck ? friction.static_limit : friction.dynamic_limit);
  const double viscous = held.length * friction.viscous;
  add_friction_rows(viscous > 0.0 ? at.h / viscous : 0.0, std::move(row), mine, set);
  return mine;
}

/// Compliance between two groups: that between their hats, by what these have of the lengths.
double between(const core::MatX& C, const Held& a, const Held& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.share.size(); ++i)
    for (std::size_t j = 0; j < b.share.size(); ++j)
      sum += a.share[i] * b.share[j] *
             C(a.group.first + static_cast<int>(i), b.group.first + static_cast<int>(j));
  return sum;
}

/// Adds the compliance that the mesh hides. Directions turn along a bent shaft: what acts between
/// two rows is the part that they have in common.
void add_hidden(const LineCompliance& hidden, const std::vector<Held>& held,
                const std::vector<PointRows>& rows, constraint::Set& set)
{
  const auto add = [&](int i, int j, double compliance) {
    if (i >= 0 && j >= 0 && compliance != 0.0) set.couplings().push_back({i, j, compliance});
  };
  for (std::size_t a = 0; a < held.size(); ++a)
    for (std::size_t b = a; b < held.size(); ++b) {
      const needle::ShaftPoint &on_a = held[a].on_shaft, &on_b = held[b].on_shaft;
      const double axial = between(hidden.axial, held[a], held[b]);
      const double lateral = between(hidden.lateral, held[a], held[b]);
      const std::array<Vec3, 2> n_a{on_a.normal_1, on_a.normal_2},
          n_b{on_b.normal_1, on_b.normal_2};
      for (int i : {0, 1})
        for (int j : {0, 1})
          if (a != b || i <= j)
            add(rows[a].first + i, rows[b].first + j,
                lateral * n_a[static_cast<std::size_t>(i)].dot(n_b[static_cast<std::size_t>(j)]));
      const double along = axial * on_a.tangent.dot(on_b.tangent);
      add(rows[a].axial, rows[b].axial, along);
      add(rows[a].viscous, rows[b].viscous, along);
      add(rows[a].axial, rows[b].viscous, along);
      if (a != b) add(rows[a].viscous, rows[b].axial, along);
    }
}

}  // namespace

std::vector<PointRows> add_line_rows(const Ground& ground, const InsertionState& state,
                                     const Iterate& at, constraint::Set& set)
{
  const Line& line = state.path.line;
  const std::vector<Place> all = places(line, at);
  std::vector<Held> held;
  std::vector<PointRows> rows;
  for (const HatGroup& group : groups(line, state.tip_arc)) {
    held.push_back(held_by(state, group, all, at.shaft));
    rows.push_back(add_rows_of(ground, state, held.back(), at, set));
  }
  const double radius = at.shaft.radius;
  add_hidden(hidden_compliance(ground, line, state.tip_arc, radius), held, rows, set);
  return rows;
}

}  // namespace trocar::insertion
