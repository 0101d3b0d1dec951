#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "insertion/channel.hpp"
#include "insertion/line_compliance.hpp"
#include "insertion/line_rows.hpp"
#include "insertion/ring.hpp"
#include "support/block.hpp"

namespace trocar::insertion {
namespace {

/// A block whose cells get longer along x, with a border between two tissues in the middle.
test::BlockShape graded(double jitter)
{
  test::BlockShape shape{8, 4, 4, Vec3(0.06, 0.04, 0.04), jitter};
  shape.map = [](const Vec3& X) -> Vec3 {
    const double t = X.x() / 0.06;
    return {0.06 * t * (0.5 + 0.5 * t), X.y(), X.z()};
  };
  return shape;
}

/// What a needle of radius 0.5 mm goes into, with placement `line`.
struct Block
{
  explicit Block(const test::BlockShape& shape, double ratio = 1.0)
      : mesh(with_layers(shape)),
        locator(mesh),
        ground(mesh, locator, settings(shape.quadratic), {{5000.0, 0.45}, {5000.0 * ratio, 0.3}})
  {
  }
  static mesh::Mesh with_layers(const test::BlockShape& shape)
  {
    mesh::Mesh mesh = test::block(shape);
    mesh.volumes = {"near", "far"};
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto c = mesh::corners(mesh, static_cast<int>(t));
      mesh.region[t] = 0.25 * (c[0] + c[1] + c[2] + c[3]).x() > 0.02 ? 1 : 0;
    }
    return mesh;
  }
  static InsertionSettings settings(bool quadratic)
  {
    InsertionSettings settings;
    settings.placement.placement = Placement::line;
    settings.line = {quadratic ? 0.8 : 1.4, quadratic ? 0.25 : 0.35};
    settings.friction.resize(2);
    for (TissueFriction& both : settings.friction) both.advance = both.withdraw = {10.0, 10.0, 0.0};
    return settings;
  }
  /// A straight needle from the surface at x = 0, `depth` [m] deep.
  needle::Shaft shaft(double depth) const
  {
    needle::Shaft shaft;
    shaft.length = 0.08;
    shaft.radius = 0.0005;
    core::Mat3 R;
    R.col(0) = direction;
    R.col(1) = direction.unitOrthogonal();
    R.col(2) = R.col(0).cross(R.col(1));
    const Vec3 base = entry + (depth - shaft.length) * direction;
    for (int n = 0; n <= 10; ++n) {
      shaft.x.push_back(base + 0.1 * n * shaft.length * direction);
      shaft.R.push_back(R);
    }
    return shaft;
  }
  /// The path `depth` deep, cut in `parts` equal parts.
  InsertionState inserted(double depth, int parts = 1) const
  {
    InsertionState state;
    state.phase = Phase::inserted;
    grow(state.path, entry, ground.field());
    for (int n = 1; n <= parts; ++n) {
      grow(state.path, entry + depth * n / parts * direction, ground.field());
      hold_behind(ground, state, state.path.length(), shaft(depth * n / parts));
    }
    return state;
  }

  Vec3 entry{0.0, 0.0193, 0.0207};
  Vec3 direction = Vec3(1.0, 0.05, -0.03).normalized();
  mesh::Mesh mesh;
  mesh::Locator locator;
  Ground ground;
};

// ∬ of the kernels by the midpoint rule, on one, neighbouring and distant intervals.
TEST(LineCompliance, IsTheDoubleIntegralOfItsKernels)
{
  const double r = 0.5, R = 1.7;
  const LinearPart f{0.0, 2.0, 0.3, 0.4};
  for (const LinearPart& g :
       {f, LinearPart{2.0, 3.5, 1.0, -0.7}, LinearPart{11.0, 14.0, 0.2, 0.1}}) {
    constexpr int n = 600;
    double along = 0.0, across = 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double of_f = (i + 0.5) / n * (f.end - f.begin);
        const double of_g = (j + 0.5) / n * (g.end - g.begin);
        const double d = f.begin + of_f - g.begin - of_g;
        const double a = d * d + r * r, b = d * d + R * R;
        const double weight = (f.value + f.slope * of_f) * (g.value + g.slope * of_g) *
                              (f.end - f.begin) * (g.end - g.begin) / n / n;
        const double first = 1.0 / std::sqrt(a) - 1.0 / std::sqrt(b);
        along += weight * first;
        across += weight * (first + 0.5 * (r * r * std::pow(a, -1.5) - R * R * std::pow(b, -1.5)));
      }
    const Potential found = potential(f, g, r, R);
    EXPECT_NEAR(found.along, along, 1e-5 * std::abs(along));
    EXPECT_NEAR(found.across, across, 1e-5 * (std::abs(along) + std::abs(across)));
  }
}

// No forces can gain energy from what the mesh hides, however sizes and stiffness vary.
TEST(LineCompliance, IsPositiveSemidefinite)
{
  for (const bool quadratic : {false, true})
    for (const double ratio : {1.0, 10.0, 0.01}) {
      test::BlockShape shape = graded(0.2);
      shape.quadratic = quadratic;
      const Block block(shape, ratio);
      for (const double depth : {0.0003, 0.011, 0.0247, 0.05}) {
        const InsertionState state = block.inserted(depth);
        const LineCompliance C =
            hidden_compliance(block.ground, state.path.line, state.tip_arc, 0.0005);
        for (const core::MatX& one : {C.axial, C.lateral}) {
          EXPECT_EQ((one - one.transpose()).norm(), 0.0);
          const core::VecX values = one.selfadjointView<Eigen::Lower>().eigenvalues();
          EXPECT_GE(values.minCoeff(), -1e-12 * values.maxCoeff());
          EXPECT_GT(values.maxCoeff(), 0.0);
        }
      }
    }
}

// A density of one everywhere is held by weights that sum up to the whole, on every stretch.
TEST(Line, HatsShareThePath)
{
  for (const bool quadratic : {false, true}) {
    test::BlockShape shape = graded(0.2);
    shape.quadratic = quadratic;
    Block block(shape);
    block.ground.settings.friction[1].advance.dynamic_limit = 5.0;  // two stretches
    const InsertionState state = block.inserted(0.0473, 3);
    const Line& line = state.path.line;
    ASSERT_GE(line.stretches.size(), 2u);  // the border is jagged
    double length = 0.0, held = 0.0;
    each_station(line, [&](const Station& station) {
      double sum = 0.0;
      for (int k = 0; k < line.hats(); ++k) sum += hat(line, k, station.stretch, station.arc);
      EXPECT_NEAR(sum, 1.0, 1e-14);
      EXPECT_NEAR(station.ring.weight.sum(), 1.0, 1e-13);
      length += station.length;
    });
    EXPECT_NEAR(length, 0.0473, 1e-16);
    for (int k = 0; k < line.hats(); ++k) held += moments(line, k, 0.0, state.tip_arc).length;
    EXPECT_NEAR(held, 0.0473, 1e-16);
    EXPECT_NEAR(tributary_lengths(block.mesh, state).sum(), 0.0473, 1e-16);
    for (const CouplingPoint& point : state.points)
      EXPECT_NEAR(state.path.sites[static_cast<std::size_t>(point.site)].anchor.weight.sum(), 1.0,
                  1e-13);
  }
}

// The grid and what it holds behind the tip do not depend on the steps that led there, and going on
// changes nothing of what lies behind.
TEST(Line, IsFixedInTheTissue)
{
  const Block block(graded(0.2));
  const InsertionState once = block.inserted(0.04), often = block.inserted(0.04, 173);
  const Line &a = once.path.line, &b = often.path.line;
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t k = 0; k < a.nodes.size(); ++k)
    EXPECT_NEAR(a.nodes[k].arc, b.nodes[k].arc, 1e-12);
  for (std::size_t k = 0; k + 1 < once.path.sites.size(); ++k) {
    const auto &p = once.path.sites[k].anchor, &q = often.path.sites[k].anchor;
    ASSERT_EQ(p.node, q.node);
    EXPECT_LT((p.weight - q.weight).cwiseAbs().maxCoeff(), 1e-9);
  }
  // Drawn back by half the path and in again: all as before.
  InsertionState back = once;
  hold_behind(block.ground, back, 0.02, block.shaft(0.02));
  EXPECT_LT(back.points.size(), once.points.size());
  hold_behind(block.ground, back, 0.04, block.shaft(0.04));
  ASSERT_EQ(back.points.size(), once.points.size());
  for (std::size_t k = 0; k < once.path.sites.size(); ++k)
    EXPECT_EQ(back.path.sites[k].anchor.node, once.path.sites[k].anchor.node);
}

// A point born anywhere has its place on the needle: without slip it lies opposite to itself.
TEST(Line, KnowsWhereItSticksOnTheNeedle)
{
  const Block block(graded(0.2));
  const fem::GlobalField undeformed{core::VecX::Zero(3 * block.mesh.node_count())};
  const Deformed tissue(block.mesh, block.locator, undeformed);
  InsertionState state = block.inserted(0.04, 29);
  const auto largest_gap = [&](double depth) {
    constraint::Set set;
    const needle::Shaft shaft = block.shaft(depth);
    double largest = 0.0;
    for (const PointRows& rows :
         add_line_rows(block.ground, state, {shaft, tissue, 0, 0.01}, set)) {
      const auto& across = set.rows()[static_cast<std::size_t>(rows.first)];
      largest = std::max(largest, std::abs(across.gap));
      largest = std::max(largest, std::abs(rows.slid + 0.04 / 29));
    }
    return largest;
  };
  // What was newly passed counts as having slipped for its step; the rest has not moved at all.
  for (CouplingPoint& point : state.points) {
    const HatMoments held = moments(state.path.line, point.site, 0.0, state.tip_arc);
    point.needle_arc = 0.08 - 0.04 + 0.04 / 29 + held.arc / held.length;
  }
  EXPECT_LT(largest_gap(0.04), 1e-12);
  hold_behind(block.ground, state, 0.0137, block.shaft(0.0137));
  constraint::Set set;
  const needle::Shaft shaft = block.shaft(0.0137);
  for (const PointRows& rows : add_line_rows(block.ground, state, {shaft, tissue, 0, 0.01}, set))
    EXPECT_NEAR(rows.slid, 0.04 - 0.04 / 29 - 0.0137, 1e-12);  // drawn back by the rest
}

// Forces and moments of any multipliers are equal and opposite on tissue and needle, on full rings
// and on those at the surface, on a straight needle.
TEST(Line, ActsAlikeOnBothSides)
{
  for (const bool quadratic : {false, true}) {
    test::BlockShape shape{6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.2};
    shape.quadratic = quadratic;
    Block block(shape);
    block.entry = Vec3(0.0, 0.0017, 0.0207);  // near a side
    block.direction = Vec3(1.0, 0.3, -0.2).normalized();
    const fem::GlobalField undeformed{core::VecX::Zero(3 * block.mesh.node_count())};
    const Deformed tissue(block.mesh, block.locator, undeformed);
    const InsertionState state = block.inserted(0.0413);
    const needle::Shaft shaft = block.shaft(0.0413);
    constraint::Set set;
    const auto rows = add_line_rows(block.ground, state, {shaft, tissue, 0, 0.01}, set);
    ASSERT_GT(rows.size(), 3u);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-1.0, 1.0);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.0;
    for (const constraint::Row& row : set.rows()) {
      const double lambda = some(random);
      size += std::abs(lambda);
      for (const constraint::TissueTerm& term : row.tissue)
        for (std::size_t a = 0; a < term.anchor.node.size(); ++a) {
          const Vec3 f = lambda * term.anchor.weight[static_cast<Eigen::Index>(a)] * term.direction;
          force += f;
          moment += block.mesh.x[static_cast<std::size_t>(term.anchor.node[a])].cross(f);
        }
      for (const constraint::BodyTerm& term : row.on_body) {
        Vec3 f = Vec3::Zero();
        f[term.dof % 3] = -lambda * term.coefficient;
        const Vec3& x = shaft.x[static_cast<std::size_t>(term.dof / 6)];
        const bool turns = term.dof % 6 >= 3;
        if (!turns) force += f;
        moment += turns ? f : x.cross(f);
      }
    }
    EXPECT_LT(force.norm(), 1e-12 * size);
    EXPECT_LT(moment.norm(), 1e-12 * size * 0.08);
  }
}

// The mean place of a ring is on the axis, inside the tissue, at its surface, and where another
// body touches it.
TEST(Ring, HasItsMeanOnTheAxis)
{
  const Block block({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.2});
  for (const Vec3& X : {Vec3(0.031, 0.0193, 0.0207), Vec3(0.0002, 0.0193, 0.0207),
                        Vec3(0.03, 0.0001, 0.0207), Vec3(0.03, 0.0399, 0.0002)}) {
    const int tet = block.locator.tet_at(X);
    ASSERT_GE(tet, 0);
    for (const int points : {6, 14}) {
      const constraint::Anchor ring =
          ring_around(block.ground, X, tet, Vec3(0.6, 0.64, 0.48), {0.004, points});
      const Vec3 mean =
          ring.mean([&](int node) -> Vec3 { return block.mesh.x[static_cast<std::size_t>(node)]; });
      EXPECT_LT((mean - X).norm(), 1e-12);
      EXPECT_GE(ring.weight.minCoeff(), -1e-5);
    }
  }
}

TEST(Ring, StaysInItsBody)
{
  // Two blocks with a gap of no width: the cells beyond x = 3 cm have nodes of their own.
  test::BlockShape shape{6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.0};
  mesh::Mesh mesh = test::block(shape);
  std::map<int, int> twin;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto c = mesh::corners(mesh, static_cast<int>(t));
    if (0.25 * (c[0] + c[1] + c[2] + c[3]).x() < 0.03) continue;
    for (int& node : mesh.tets[t]) {
      if (mesh.x[static_cast<std::size_t>(node)].x() > 0.0301) continue;
      if (!twin.count(node)) {
        twin[node] = mesh.node_count();
        mesh.x.push_back(mesh.x[static_cast<std::size_t>(node)]);
        mesh.node_tag.push_back(1000000 + node);
      }
      node = twin[node];
    }
  }
  const mesh::Locator locator(mesh);
  const Ground ground(mesh, locator, Block::settings(false), {{5000.0, 0.45}});
  const Vec3 X(0.0299, 0.0193, 0.0207);
  const int tet = locator.tet_at(X);
  const constraint::Anchor ring = ring_around(ground, X, tet, Vec3::UnitY(), {0.004, 6});
  for (int node : ring.node)
    EXPECT_LE(mesh.x[static_cast<std::size_t>(node)].x(), 0.0301) << "of the other body";
  for (const auto& [own, other] : twin)
    EXPECT_EQ(std::count(ring.node.begin(), ring.node.end(), other), 0);
}

}  // namespace
}  // namespace trocar::insertion
