#include <gtest/gtest.h>

#include <cmath>

#include "support/scene.hpp"

// A needle through two bodies, the second of which has slid along the first: everything is as if it
// had been meshed where it is.
namespace trocar {
namespace {

using core::Vec3;
using insertion::Placement;

struct Kind
{
  Placement placement;
  bool quadratic;
  double gap;  ///< between the bodies [m]
};

/// Two blocks of 3 x 4 x 4 cm, each held at its outer end. The second is meshed `slid` away along y
/// and comes to its place before the needle does.
step::Scene blocks(const Kind& kind, double slid)
{
  test::BlockShape shape{7, 4, 4, Vec3(0.07, 0.04, 0.04)};
  shape.quadratic = kind.quadratic;
  shape.hole = [](const Vec3& middle) { return std::abs(middle.x() - 0.035) < 0.004; };
  shape.map = [=](const Vec3& X) {
    return X.x() > 0.035 ? Vec3(X - Vec3(0.01 - kind.gap, slid, 0.0)) : X;
  };
  step::Scene scene = test::needle_scenario(shape);
  scene.insertion.placement.placement = kind.placement;
  scene.insertion.line.kappa = kind.quadratic ? 0.8 : 1.4;
  scene.insertion.line.ring = kind.quadratic ? 0.25 : 0.35;
  scene.tissue.boundary.fixed = {{"x0", 7}};
  scene.tissue.boundary.displacements = {
      {"x1", Vec3(0, slid, 0), core::parse_csv("time,factor\n0,0\n0.1,1\n1000,1\n", "slide.csv")}};
  scene.laws.tolerance = 1e-12;
  scene.time.is_static = true;
  scene.time.step = 0.05;
  scene.time.end = 2.0;
  needle::NeedleSettings& needle = scene.needles[0];
  needle.motion.entry = Vec3(-0.003, 0.0173, 0.0231);
  needle.motion.length = 0.1;
  needle.motion.depth = 0.055;
  needle.motion.velocity = 0.04;
  scene.insertion.friction = test::same({5.0, 4.0, 0.0});
  return scene;
}

const Kind kinds[] = {
    {Placement::crossings, false, 0.0}, {Placement::crossings, true, 0.003},
    {Placement::spacing, false, 0.003}, {Placement::line, false, 0.0},
    {Placement::line, true, 0.003},     {Placement::line, true, 0.0},
};

void expect_equal(const test::Run& slid, const test::Run& straight)
{
  ASSERT_EQ(slid.reports.size(), straight.reports.size());
  double largest = 0.0;
  for (const step::StepReport& report : straight.reports)
    largest = std::max(largest, report.needles[0].base.force.norm());
  for (std::size_t n = 2; n < slid.reports.size(); ++n) {
    const step::NeedleReport &one = slid.reports[n].needles[0],
                             &other = straight.reports[n].needles[0];
    EXPECT_EQ(slid.reports[n].rows, straight.reports[n].rows) << n;
    EXPECT_EQ(slid.states[n].insertions[0].tip.punctures,
              straight.states[n].insertions[0].tip.punctures)
        << n;
    EXPECT_NEAR(one.depth, other.depth, 1e-9 * 0.05) << n;
    EXPECT_LT((one.base.force - other.base.force).norm(), 2e-9 * largest) << n;
    EXPECT_LT((one.base.moment - other.base.moment).norm(), 2e-9 * 0.1 * largest) << n;
  }
  EXPECT_GT(largest, 0.05);
}

/// The path jumps once, and no segment of it goes from one body to the other.
void expect_one_jump(const insertion::Path& path)
{
  ASSERT_EQ(path.jumps.size(), 1u);
  for (std::size_t i = 1; i < path.vertex.size(); ++i) {
    const double aside = std::abs(path.vertex[i].y() - path.vertex[i - 1].y());
    EXPECT_EQ(aside > 1e-3, static_cast<int>(i) == path.jumps[0]) << i;
  }
}

TEST(Bodies, ABodyThatSlidIsPiercedWhereItIs)
{
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.placement) * 100 + kind.quadratic * 10 + (kind.gap > 0.0));
    const test::Run slid = test::run(blocks(kind, 0.01));
    expect_equal(slid, test::run(blocks(kind, 0.0)));
    expect_one_jump(slid.states.back().insertions[0].path);
    EXPECT_NEAR(slid.reports.back().needles[0].depth, 0.052 - kind.gap, 0.0015);
  }
}

// Out of the second body, through the gap, into the first and forth again.
TEST(Bodies, TheTipComesOutAndInAgain)
{
  for (Kind kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.placement) * 100 + kind.quadratic * 10 + (kind.gap > 0.0));
    const auto cycle = [&](double slid) {
      step::Scene scene = blocks(kind, slid);
      scene.needles[0].motion.trajectory = core::parse_csv(
          "time,x,y,z\n0,-0.103,0.0173,0.0231\n1,-0.053,0.0173,0.0231\n"
          "1.6,-0.083,0.0173,0.0231\n2.2,-0.053,0.0173,0.0231\n3.4,-0.108,0.0173,0.0231\n",
          "cycle.csv");
      scene.time.end = 3.2;
      return scene;
    };
    const test::Run slid = test::run(cycle(0.01));
    expect_equal(slid, test::run(cycle(0.0)));
    const std::size_t in = 20, between = 32, again = 44;
    EXPECT_NEAR(slid.reports[again].needles[0].depth, slid.reports[in].needles[0].depth, 2e-4);
    EXPECT_NEAR(slid.reports[between].needles[0].depth, 0.017, 0.002);
    EXPECT_EQ(slid.states.back().insertions[0].path.jumps.size(), 1u);
  }
}

// Each body has a skin of its own: three are pierced on the way into the second body.
TEST(Bodies, EverySurfaceIsPierced)
{
  for (Kind kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.placement) * 100 + kind.quadratic * 10 + (kind.gap > 0.0));
    const auto skins = [&](double slid) {
      step::Scene scene = blocks(kind, slid);
      scene.insertion.puncture.volume = {0.05};
      scene.insertion.friction = test::same({1.0, 1.0, 0.0});
      return scene;
    };
    const test::Run slid = test::run(skins(0.01));
    expect_equal(slid, test::run(skins(0.0)));
    EXPECT_EQ(slid.states.back().insertions[0].tip.punctures, 3);
    double peak = 0.0;
    for (const step::StepReport& report : slid.reports)
      peak = std::max(peak, report.needles[0].coupling.tip_force);
    EXPECT_NEAR(peak, 0.05, 1e-9);
  }
}

}  // namespace
}  // namespace trocar
