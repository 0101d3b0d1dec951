#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/tip.hpp"

namespace trocar {
namespace {

using core::Vec3;
using insertion::Phase;
using test::layered;
using test::scene;

// The three states of a puncture: no force, a contact that grows to exactly f_p, and then the drop
// to the cutting force. Held for long below f_p nothing happens.
TEST(Puncture, HappensAtTheThresholdAndNeverBelow)
{
  step::Scene scenario = scene(0.3, 0.1);
  scenario.time.end = 1.0;
  const test::Run run = test::run(scenario);
  double peak = 0.0;
  double travel = 0.0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double force = run.reports[n].needles[0].coupling.tip_force;
    if (run.states[n].insertions[0].tip.punctures == 0) {
      EXPECT_EQ(run.reports[n].needles[0].depth, 0.0);
      travel = run.reports[n].needles[0].tip.x();
    } else if (run.states[n - 1].insertions[0].tip.punctures == 1) {
      EXPECT_NEAR(force, 0.1, 1e-12);
    }
    peak = std::max(peak, force);
  }
  EXPECT_NEAR(peak, 0.3, 1e-12);
  EXPECT_EQ(run.states.back().insertions[0].tip.punctures, 1);

  scenario.needles[0].motion.depth = 0.9 * travel;
  scenario.time.end = 6.0;
  const test::Run below = test::run(scenario);
  EXPECT_EQ(below.states.back().insertions[0].tip.punctures, 0);
  EXPECT_EQ(below.states.back().insertions[0].phase, Phase::contact);
  const double held = below.reports.back().needles[0].coupling.tip_force;
  EXPECT_GT(held, 0.2);
  EXPECT_LT(held, 0.3);
}

TEST(Puncture, TheTipLeavesASurfaceItDidNotPunctureWithoutPulling)
{
  step::Scene scenario = scene(10.0, 0.0);
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.depth = 0.004;
  motion.withdraw_velocity = 0.02;
  scenario.time.end = 1.0;
  const test::Run run = test::run(scenario);
  bool touched = false;
  for (const auto& report : run.reports) {
    EXPECT_GE(report.needles[0].coupling.tip_force, 0.0);
    touched = touched || report.needles[0].coupling.tip_force > 0.01;
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(run.states.back().insertions[0].phase, Phase::outside);
  EXPECT_EQ(run.reports.back().rows, 0);
}

/// Travel of the tip per force on the middle of a face of a cube with edge 20 a, fixed on the
/// opposite face.
double indentation(int cells, double radius, double poisson)
{
  const double edge = 0.1;
  step::Scene scenario = test::needle_scenario({cells, cells, cells, Vec3(edge, edge, edge), 0.0});
  scenario.tissue.materials = {{5000.0, poisson, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed = {{"x1", 7}};
  scenario.time.is_static = true;
  scenario.time.end = 0.04;
  scenario.needles[0].motion.entry = Vec3(0, 0.0503, 0.0497);
  scenario.insertion.friction = test::same({0.0, 0.0, 0.0});
  scenario.insertion.puncture.volume = {1.0};
  scenario.insertion.tip = {{0.0}, radius, 1.0};
  const test::Run run = test::run(scenario);
  const auto& last = run.reports.back().needles[0];
  EXPECT_EQ(run.states.back().insertions[0].phase, Phase::contact);
  return last.tip.x() / last.coupling.tip_force;
}

// Hertz's pressure p0 sqrt(1 - r²/a²) on a half-space: displacement (1-ν²) π p0 (2a² - r²) / (4 E
// a), whose mean with that pressure is 3 (1-ν²) F / (5 E a). A cube of edge 5 a, fixed below, is
// stiffer by some percent; what counts is that the value does not depend on the mesh: with the
// radius given, equal force means equal indentation, hence puncture.
TEST(Puncture, SupportOfGivenRadiusDoesNotDependOnTheMesh)
{
  const double radius = 0.02;
  const double hertz = 3.0 * (1.0 - 0.09) / (5.0 * 5000.0 * radius);
  const double coarse = indentation(10, radius, 0.3);
  const double fine = indentation(16, radius, 0.3);
  EXPECT_NEAR(fine / hertz, 1.0, 0.12);
  EXPECT_NEAR(coarse / fine, 1.0, 0.12);
}

// Turned as a whole, and entered at an angle: the same punctures, depth and force.
TEST(Puncture, DoesNotDependOnHowTheBodyLies)
{
  Vec3 force = Vec3::Zero();
  double depth = 0.0;
  for (int turn = 0; turn < 4; ++turn) {
    step::Scene scenario = layered();
    scenario.insertion.puncture.volume = {0.1, 0.4};
    scenario.insertion.tip.radius = 0.012;
    needle::BaseMotion& motion = scenario.needles[0].motion;
    motion.direction = Vec3(1.0, 0.21, -0.13).normalized();
    const Vec3 axis = turn * Vec3(0.7, -0.4, 0.9);
    const core::Mat3 Q = core::rotation_exp(axis);
    const Vec3 shift = turn * Vec3(0.11, -0.07, 0.05);
    for (Vec3& x : scenario.mesh.x) x = Q * x + shift;
    motion.entry = Q * motion.entry + shift;
    const core::Mat3 turned = Q * core::frame_along(motion.direction);
    motion.direction = Q * motion.direction;
    // The base's own frame turns with the body as well.
    const core::Mat3 lies = core::frame_along(motion.direction);
    motion.roll = std::atan2(turned.col(1).dot(lies.col(2)), turned.col(1).dot(lies.col(1)));
    const test::Run run = test::run(scenario);
    EXPECT_EQ(run.states.back().insertions[0].tip.punctures, 2);
    const Vec3 mine = Q.transpose() * run.reports.back().needles[0].base.force;
    if (turn == 0) {
      force = mine;
      depth = run.reports.back().needles[0].depth;
      EXPECT_GT(depth, 0.04);
    }
    EXPECT_LT((mine - force).norm(), 1e-6 * force.norm());
    EXPECT_NEAR(run.reports.back().needles[0].depth, depth, 1e-8);
  }
}

TEST(Puncture, IsAskedForAgainAtAnotherPlace)
{
  step::Scene scenario = scene(0.2, 0.05);
  scenario.needles[0].motion.trajectory = core::parse_csv(
      "time,x,y,z\n0,-0.08,0.0131,0.0231\n1,-0.05,0.0131,0.0231\n2,-0.09,0.0131,0.0231\n"
      "2.5,-0.09,0.0271,0.0231\n4,-0.05,0.0271,0.0231\n5,-0.09,0.0271,0.0231\n",
      "twice.csv");
  scenario.time.end = 5.0;
  const test::Run run = test::run(scenario);
  EXPECT_EQ(run.states[100].insertions[0].tip.punctures, 1);
  EXPECT_EQ(run.states[200].insertions[0].tip.punctures, 2);
  EXPECT_GT(run.reports[200].needles[0].depth, 0.02);
  EXPECT_EQ(run.reports.back().rows, 0);
}

// A tip pressed on a surface and drawn aside slides with Coulomb's force, loses what it is given as
// friction, and presses on nothing once it is beside the body.
TEST(Surface, ATipDrawnAsideSlidesAndFallsOff)
{
  step::Scene scenario = scene(10.0, 0.0);
  scenario.insertion.tip.friction = 0.3;
  scenario.energy = true;
  scenario.needles[0].motion.entry = Vec3(0, 0.02, 0.0231);
  scenario.needles[0].motion.trajectory = core::parse_csv(
      "time,x,y,z\n0,-0.08,0.02,0.0231\n0.2,-0.078,0.02,0.0231\n2.2,-0.078,0.05,0.0231\n",
      "aside.csv");
  scenario.time.end = 2.2;
  const test::Run run = test::run(scenario);
  int sliding = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const auto& tip = run.states[n].insertions[0].tip;
    if (run.states[n].insertions[0].phase == Phase::contact) {
      const double lateral = tip.lambda.head<2>().norm();
      EXPECT_LE(lateral, std::sqrt(2.0) * 0.3 * tip.lambda[2] * (1.0 + 1e-6) + 1e-7);
      sliding += lateral > 0.25 * tip.lambda[2] ? 1 : 0;
    }
    if (run.reports[n].needles[0].tip.y() > 0.045) {
      EXPECT_EQ(run.reports[n].needles[0].coupling.tip_force, 0.0);
    }
  }
  EXPECT_GT(sliding, 30);
  const step::EnergyAccount& e = run.states.back().energy;
  EXPECT_GT(e.friction, 0.2 * e.supplied);
  EXPECT_LT(std::abs(e.rest()), 0.15 * e.supplied);
}

}  // namespace
}  // namespace trocar
