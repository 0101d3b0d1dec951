#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "insertion/channel.hpp"
#include "insertion/coupling.hpp"
#include "insertion/deformed.hpp"
#include "support/block.hpp"

namespace trocar::insertion {
namespace {

using core::Vec3;

/// 6 x 4 x 4 cm in cells of 1 cm.
const test::BlockShape bar{6, 4, 4, Vec3(0.06, 0.04, 0.04)};

struct Scene
{
  explicit Scene(const test::BlockShape& shape) : mesh(test::block(shape)), locator(mesh) {}
  Path straight(const Vec3& from, const Vec3& to, const PlacementSettings& settings = {},
                int parts = 1) const
  {
    Path path;
    for (int i = 0; i <= parts; ++i)
      grow(path, from + (to - from) * i / parts, {mesh, locator, settings});
    return path;
  }
  mesh::Mesh mesh;
  mesh::Locator locator;
};

constexpr PlacementSettings raw{Placement::crossings, 0.005, 0.0};

Vec3 place(const mesh::Mesh& mesh, const Site& site)
{
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a)
    x += site.anchor.weight[static_cast<Eigen::Index>(a)] *
         mesh.x[static_cast<std::size_t>(site.anchor.node[a])];
  return x;
}

TEST(Crossings, LieOnFacesAtTheirArcAndCloseThePathAtBothEnds)
{
  const Scene scene({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.2});
  const Vec3 from(0, 0.0173, 0.0131), to(0.06, 0.0241, 0.0187);
  const Path path = scene.straight(from, to, raw);
  const Vec3 d = (to - from).normalized();
  EXPECT_GT(path.sites.size(), 12U);
  EXPECT_NEAR(path.sites.front().arc, 0.0, 1e-9);
  EXPECT_NEAR(path.sites.back().arc, path.length(), 1e-9);
  for (const Site& site : path.sites) {
    EXPECT_LT((place(scene.mesh, site) - (from + site.arc * d)).norm(), 1e-7);
    EXPECT_GE(std::count(site.anchor.weight.data(), site.anchor.weight.data() + 4, 0.0), 1);
    EXPECT_GE(site.anchor.weight.minCoeff(), 0.0);
  }
  EXPECT_NEAR(tissue_length(path, path.length()), path.length(), 1e-12);
}

// Every tie there is: along an edge, in a face plane, through vertices. Cells of 1 cm.
TEST(Crossings, SurviveVerticesEdgesAndFacePlanes)
{
  const Scene scene(bar);
  // Along the grid line: edges of the mesh, vertices every centimetre.
  EXPECT_EQ(scene.straight(Vec3(0, 0.02, 0.02), Vec3(0.06, 0.02, 0.02), raw).sites.size(), 7U);
  // Along the main diagonals of the cells: again edges.
  EXPECT_EQ(scene.straight(Vec3(0, 0, 0), Vec3(0.04, 0.04, 0.04), raw).sites.size(), 5U);
  // In the plane z = 0.02 of faces, general position within it: cell sides and face diagonals.
  const Path plane = scene.straight(Vec3(0, 0.0123, 0.02), Vec3(0.06, 0.0123, 0.02), raw);
  EXPECT_EQ(plane.sites.size(), 13U);
  for (const Site& site : plane.sites) EXPECT_NEAR(place(scene.mesh, site).z(), 0.02, 1e-12);
  for (const Path& path : {plane}) EXPECT_NEAR(tissue_length(path, 1.0), 0.06, 1e-12);
}

TEST(Crossings, DoNotDependOnHowTheTipGotThere)
{
  const Scene scene(bar);
  for (const auto& [from, to] : {std::pair{Vec3(0, 0.02, 0.02), Vec3(0.06, 0.02, 0.02)},
                                 std::pair{Vec3(0, 0.0123, 0.02), Vec3(0.06, 0.0123, 0.02)},
                                 std::pair{Vec3(0, 0.0171, 0.0057), Vec3(0.05, 0.031, 0.033)}}) {
    const Path once = scene.straight(from, to, raw);
    for (int parts : {2, 6, 12, 37, 600}) {
      const Path often = scene.straight(from, to, raw, parts);
      ASSERT_EQ(often.sites.size(), once.sites.size()) << parts << " parts";
      for (std::size_t i = 0; i < once.sites.size(); ++i)
        EXPECT_NEAR(often.sites[i].arc, once.sites[i].arc, 2e-8);
      EXPECT_NEAR(tissue_length(often, 1.0), tissue_length(once, 1.0), 1e-12);
    }
  }
}

TEST(Crossings, RoundOffNeverDecidesATie)
{
  const Scene scene(bar);
  // Tip within 1e-6 of an edge of a face: before or behind it makes no difference.
  for (double off : {-1e-13, 0.0, 1e-13, -3e-9, 3e-9})
    EXPECT_EQ(scene.straight(Vec3(0, 0.02 + off, 0.02), Vec3(0.03 + off, 0.02, 0.02 - off), raw)
                  .sites.size(),
              4U)
        << off;
}

TEST(Crossings, AMillionthOfAnEdgeOutsideIsInside)
{
  const Scene scene(bar);
  for (double off : {0.0, 1e-9, 5e-9}) {
    const Path path =
        scene.straight(Vec3(0, 0.0123, 0.04 + off), Vec3(0.03, 0.0123, 0.04 + off), raw);
    EXPECT_NEAR(tissue_length(path, 1.0), 0.03, 1e-9);
    EXPECT_EQ(path.sites.size(), 7U);
  }
}

TEST(Crossings, VoidsAreLeftOutAndTheirWallsAreCrossings)
{
  test::BlockShape shape = bar;
  shape.hole = [](const Vec3& p) {
    return p.x() > 0.02 && p.x() < 0.04 && p.z() > 0.01 && p.z() < 0.03;
  };
  const Scene scene(shape);
  const Path path = scene.straight(Vec3(0, 0.0171, 0.0223), Vec3(0.06, 0.0171, 0.0223), raw);
  EXPECT_NEAR(tissue_length(path, 1.0), 0.04, 1e-9);
  for (const Site& site : path.sites) EXPECT_FALSE(site.arc > 0.0201 && site.arc < 0.0399);
  EXPECT_TRUE(std::any_of(path.sites.begin(), path.sites.end(),
                          [](const Site& s) { return std::abs(s.arc - 0.02) < 1e-9; }));
  EXPECT_TRUE(std::any_of(path.sites.begin(), path.sites.end(),
                          [](const Site& s) { return std::abs(s.arc - 0.04) < 1e-9; }));
}

TEST(Crossings, APathThatLeavesOnTheFarSideEndsThere)
{
  const Scene scene(bar);
  const Path path = scene.straight(Vec3(-0.01, 0.0171, 0.0223), Vec3(0.09, 0.0171, 0.0223), raw, 7);
  EXPECT_NEAR(tissue_length(path, 1.0), 0.06, 1e-9);
  EXPECT_NEAR(path.sites.front().arc, 0.01, 1e-9);
  EXPECT_NEAR(path.sites.back().arc, 0.07, 1e-9);
}

TEST(Crossings, MergingDropsTheNewerOfTwoClosePoints)
{
  const Scene scene({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.25});
  const Vec3 from(0, 0.0173, 0.0131), to(0.06, 0.0241, 0.0187);
  const Path all = scene.straight(from, to, raw);
  const Path merged = scene.straight(from, to, {Placement::crossings, 0.005, 0.3}, 50);
  EXPECT_LT(merged.sites.size(), all.sites.size());
  EXPECT_EQ(merged.crossings.size(), all.crossings.size());
  const auto smallest_gap = [](const Path& path) {
    double smallest = 1.0;
    for (std::size_t i = 1; i < path.sites.size(); ++i)
      smallest = std::min(smallest, path.sites[i].arc - path.sites[i - 1].arc);
    return smallest;
  };
  EXPECT_GT(smallest_gap(merged), 0.3 * 0.007);
  EXPECT_GT(smallest_gap(merged), smallest_gap(all));
}

TEST(Spacing, PlacesOnePointPerDistanceWithBothEnds)
{
  const Scene scene(bar);
  for (double d : {0.01, 0.005, 0.002, 0.0007})
    for (int parts : {1, 3, 11}) {
      const Path path = scene.straight(Vec3(0, 0.0171, 0.0223), Vec3(0.06, 0.0171, 0.0223),
                                       {Placement::spacing, d, 0.3}, parts);
      EXPECT_EQ(path.sites.size(), static_cast<std::size_t>(0.06 / d + 1e-9) + 1) << d;
    }
}

TEST(Path, ArcNearestGoesOnBeyondBothEnds)
{
  const Scene scene(bar);
  const Path path = scene.straight(Vec3(0.01, 0.02, 0.02), Vec3(0.03, 0.02, 0.02), raw, 4);
  EXPECT_NEAR(arc_nearest(path, Vec3(0.0, 0.021, 0.02)), -0.01, 1e-12);
  EXPECT_NEAR(arc_nearest(path, Vec3(0.017, 0.02, 0.03)), 0.007, 1e-12);
  EXPECT_NEAR(arc_nearest(path, Vec3(0.05, 0.02, 0.02)), 0.04, 1e-12);
}

TEST(Deformed, PullsWorldPointsBackThroughTheDeformation)
{
  const Scene scene({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.2});
  fem::GlobalField u{core::VecX::Zero(3 * scene.mesh.node_count())};
  const auto map = [](const Vec3& X) {
    return Vec3(X.x() + 0.3 * X.z() * X.x() / 0.06, X.y() * 1.1, X.z() - 0.2 * X.x());
  };
  for (int i = 0; i < scene.mesh.node_count(); ++i)
    u.node(i) =
        map(scene.mesh.x[static_cast<std::size_t>(i)]) - scene.mesh.x[static_cast<std::size_t>(i)];
  const Deformed tissue(scene.mesh, scene.locator, u);
  for (int t = 0; t < scene.mesh.tet_count(); t += 37) {
    const mesh::Tet& tet = scene.mesh.tets[static_cast<std::size_t>(t)];
    const constraint::Anchor anchor{{tet.begin(), tet.end()}, Eigen::Vector4d(0.1, 0.2, 0.3, 0.4)};
    Vec3 X = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a)
      X += anchor.weight[static_cast<Eigen::Index>(a)] *
           scene.mesh.x[static_cast<std::size_t>(anchor.node[a])];
    const Vec3 x = tissue.position(anchor);
    for (const Vec3& guess : {X, Vec3(0.03, 0.02, 0.02)}) {
      const auto back = tissue.reference_place(x, guess);
      ASSERT_TRUE(back.has_value());
      EXPECT_LT((back->X - X).norm(), 1e-12);
    }
  }
  EXPECT_FALSE(tissue.reference_place(Vec3(0.5, 0.5, 0.5), Vec3(0.03, 0.02, 0.02)).has_value());
}

TEST(Deformed, FindsWhereASegmentEnters)
{
  const Scene scene(bar);
  const fem::GlobalField u{core::VecX::Zero(3 * scene.mesh.node_count())};
  const Deformed tissue(scene.mesh, scene.locator, u);
  const auto entries = tissue.entries(Vec3(-0.05, 0.0171, 0.0223), Vec3(0.013, 0.0171, 0.0223));
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_LT((entries[0].X - Vec3(0, 0.0171, 0.0223)).norm(), 1e-9);
  EXPECT_TRUE(tissue.entries(Vec3(-0.05, 0.5, 0), Vec3(0.05, 0.5, 0)).empty());
  EXPECT_TRUE(tissue.meets(Vec3(-0.05, 0.02, 0.02), Vec3(0.0, 0.02, 0.02)));
  EXPECT_FALSE(tissue.meets(Vec3(-0.05, 0.02, 0.02), Vec3(-0.01, 0.02, 0.02)));
}

TEST(Tributary, LengthsAddUpToTheDepthWhateverTheMesh)
{
  test::BlockShape shape{9, 5, 4, Vec3(0.06, 0.04, 0.04)};
  shape.hole = [](const Vec3& p) {
    return p.x() > 0.02 && p.x() < 0.04 && p.z() > 0.01 && p.z() < 0.03;
  };
  const Scene scene(shape);
  for (const PlacementSettings& placement :
       {PlacementSettings{}, raw, PlacementSettings{Placement::spacing, 0.0031, 0.3}}) {
    const Ground ground(scene.mesh, scene.locator, {placement, {{{1, 1, 0}, {1, 1, 0}}}, 0.0, 1e-9},
                        {{2000.0, 0.4}});
    needle::NeedleSettings settings;
    settings.model = needle::Model::rigid;
    settings.section = {0.0005, 0.0, 2e11, 0.3};
    settings.motion.entry = Vec3(0, 0.0171, 0.0223);
    settings.motion.length = 0.2;
    for (double depth : {0.004, 0.0173, 0.03, 0.0587, 0.06, 0.09}) {
      settings.motion.inserted = depth;
      const InsertionState state = start(ground, needle::Needle(settings));
      const core::MatX lengths = tributary_lengths(scene.mesh, state);
      EXPECT_NEAR(lengths.sum(), insertion::depth(state), 1e-12);
      EXPECT_GE(lengths.minCoeff(), 0.0);
      EXPECT_NEAR(insertion::depth(state),
                  std::min(depth, 0.02) + std::clamp(depth - 0.04, 0.0, 0.02), 1e-9);
    }
  }
}

}  // namespace
}  // namespace trocar::insertion
