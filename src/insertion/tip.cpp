#include "insertion/tip.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "mesh/quadratic.hpp"

namespace trocar::insertion {
namespace {

/// Samples of the unit ball or (`flat`) of the unit disc normal to e_x, one of each opposite pair.
std::vector<Vec3> half_samples(bool flat)
{
  std::vector<Vec3> samples;
  if (flat) {
    constexpr int rings = 6, spokes = 6;
    for (int ring = 0; ring < rings; ++ring) {
      // Every ring carries an equal share of Hertz's force: F(<r)/F = 1 - (1 - r²)^(3/2).
      const double share = (ring + 0.5) / rings;
      const double r = std::sqrt(1.0 - std::cbrt((1.0 - share) * (1.0 - share)));
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = std::numbers::pi * (spoke + 0.5 * (ring % 2)) / spokes;
        samples.emplace_back(0.0, r * std::cos(angle), r * std::sin(angle));
      }
    }
    return samples;
  }
  constexpr int shells = 4;
  const std::vector<Vec3> directions{{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                     {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
  for (int shell = 0; shell < shells; ++shell)
    for (const Vec3& d : directions)
      samples.push_back(std::cbrt((shell + 0.5) / shells) * d.normalized());
  return samples;
}

}  // namespace

constraint::Anchor tip_support(const mesh::Mesh& mesh, const mesh::Locator& locator,
                               const Support& support, const core::Mat3& frame, bool disc)
{
  const Vec3& X = support.X;
  std::map<int, double> weight;  // by node
  const auto add = [&](int in, const Vec3& place) {
    const mesh::NodeWeights share =
        mesh::node_weights(mesh, mesh::local_coordinates(mesh::positions(mesh, in), place));
    Eigen::Index a = 0;
    for (int node : mesh::nodes_of(mesh, in)) weight[node] += share[a++];
  };
  for (const Vec3& s : half_samples(disc)) {
    const Vec3 arm = support.radius * (frame * s);
    const int one = locator.tet_at(X + arm);
    const int other = locator.tet_at(X - arm);
    if (one < 0 || other < 0) continue;
    add(one, X + arm);
    add(other, X - arm);
  }
  add(support.tet, X);
  double sum = 0.0;
  for (const auto& [node, share] : weight) sum += share;
  constraint::Anchor anchor;
  anchor.weight.resize(static_cast<Eigen::Index>(weight.size()));
  for (const auto& [node, share] : weight) {
    // A place on a face gives the opposite node a weight that is only round-off: make it 0.
    anchor.weight[static_cast<Eigen::Index>(anchor.node.size())] =
        std::abs(share) < 1e-9 * sum ? 0.0 : share / sum;
    anchor.node.push_back(node);
  }
  return anchor;
}

TipRows add_tip_rows(const TipState& tip, const TipLaw& law, const Iterate& at,
                     constraint::Set& set)
{
  TipRows mine;
  mine.limit = law.limit;
  const needle::ShaftPoint end = needle::shaft_at(at.shaft, at.shaft.length);
  const Vec3 apart = at.tissue.position(tip.hold) - tip.offset - end.x;
  const auto aim = [&](const Vec3& direction, double start) {
    auto row = constraint::Row::between({tip.hold, direction}, at.body,
                                        needle::jacobian(at.shaft, at.shaft.length, direction));
    row.gap = direction.dot(apart);
    row.start = start;
    return row;
  };
  // On a surface only the point of the tip touches, and the bevel face does not push it aside yet.
  const Vec3 ahead = end.tangent + (law.on_surface ? 0.0 : at.shaft.bevel) * end.normal_1;
  constraint::Row axial = aim(ahead, tip.lambda[2]);
  if (!law.on_surface) {
    mine.axial = set.add(std::move(axial), law::Law::interval(0.0, law.limit));
    return mine;
  }
  mine.axial = set.add(
      {std::move(axial), aim(end.normal_1, tip.lambda[0]), aim(end.normal_2, tip.lambda[1])},
      law::Law::cone(law.friction, law.limit), set.next_point());
  mine.lateral = mine.axial + 1;
  return mine;
}

TipOutcome accept_tip(TipState& tip, const TipRows& rows, const law::Multipliers& multipliers,
                      double tolerance)
{
  const double lambda = multipliers.lambda[rows.axial];
  const double delta = multipliers.delta[rows.axial];
  tip.lambda = Vec3(0.0, 0.0, lambda);
  bool slid = false;
  if (rows.lateral >= 0) {
    tip.lambda.head<2>() = multipliers.lambda.segment<2>(rows.lateral);
    slid = multipliers.delta.segment<2>(rows.lateral).norm() > tolerance;
  }
  if (delta < -tolerance && lambda >= rows.limit * (1.0 - 1e-9)) return TipOutcome::yields;
  if (delta > tolerance) return TipOutcome::apart;
  return slid ? TipOutcome::slides : TipOutcome::holds;
}

}  // namespace trocar::insertion
