#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/body.hpp"
#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using insertion::Phase;

const test::BlockShape distorted{8, 5, 5, Vec3(0.06, 0.04, 0.04), 0.25};

driver::Scenario scene(double puncture, double cutting)
{
  driver::Scenario scenario = test::needle_scenario(distorted);
  scenario.insertion.friction = test::same({2.0, 2.0, 0.0});
  scenario.insertion.puncture.volume = {puncture};
  scenario.insertion.tip.cutting = {cutting};
  return scenario;
}

// The base pushes with τ · depth + f_cut while the tip cuts, with friction alone on the way out and
// back in through the open channel, and with both again from its end on.
TEST(Cutting, ForceActsWhileTheTipAdvancesAndNotInTheOpenChannel)
{
  driver::Scenario scenario = scene(0.0, 0.15);
  scenario.needles[0].motion.trajectory = core::Csv{"in-out-in",
                                                    {"time", "x", "y", "z"},
                                                    {{0, -0.08, 0.0173, 0.0231},
                                                     {1.2, -0.056, 0.0173, 0.0231},
                                                     {1.8, -0.068, 0.0173, 0.0231},
                                                     {3.0, -0.044, 0.0173, 0.0231}}};
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  double deepest = 0.0;
  int cutting = 0, open = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const auto& needle = run.reports[n].needles[0];
    const auto& state = run.states[n].insertions[0];
    const double before = run.states[n - 1].insertions[0].path.length();
    EXPECT_NEAR(needle.base.force.x(), needle.coupling.shaft_friction + needle.coupling.tip_force,
                1e-9);
    EXPECT_GE(needle.coupling.tip_force, 0.0);
    EXPECT_LE(needle.coupling.tip_force, 0.15 + 1e-12);
    EXPECT_LE(needle.coupling.cutting_work, 1e-15);
    if (state.path.length() > before + 1e-9 && before > 0.0) {
      EXPECT_NEAR(needle.coupling.tip_force, 0.15, 1e-12);
      // No dent where points are born: all of the channel that was there rubs.
      if (before > 0.005) {
        EXPECT_NEAR(needle.coupling.shaft_friction, 2.0 * run.reports[n - 1].needles[0].depth,
                    1e-3);
      }
      ++cutting;
    }
    const bool in_channel = state.tip_arc < deepest - 1e-3;
    if (in_channel) {
      EXPECT_EQ(needle.coupling.tip_force, 0.0);
      ++open;
    }
    deepest = std::max(deepest, state.tip_arc);
  }
  EXPECT_GT(cutting, 60);
  EXPECT_GT(open, 20);
  EXPECT_EQ(run.reports.back().needles[0].coupling.tip_force, 0.15);
}

// What cannot be cut is pushed: the channel does not grow and, the tissue being linear and at rest,
// the force is in proportion to the travel.
TEST(Cutting, TheChannelGrowsOnlyByTheAdvance)
{
  driver::Scenario scenario = scene(0.0, std::numeric_limits<double>::infinity());
  scenario.time.analysis = driver::Analysis::equilibrium;
  scenario.insertion.friction = test::same({0.0, 0.0, 0.0});
  scenario.needles[0].motion.inserted = 0.02;
  scenario.time.end = 0.2;
  const test::Run run = test::run(scenario);
  const double first = run.reports[1].needles[0].coupling.tip_force;
  EXPECT_GT(first, 1e-4);
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    EXPECT_DOUBLE_EQ(run.states[n].insertions[0].path.length(), 0.02);
    EXPECT_NEAR(run.reports[n].needles[0].coupling.tip_force, static_cast<double>(n) * first,
                1e-3 * static_cast<double>(n) * first);
  }
}

// The three states of a puncture: no force, a contact that grows to exactly f_p, and then the drop
// to the cutting force. Held for long below f_p nothing happens.
TEST(Puncture, HappensAtTheThresholdAndNeverBelow)
{
  driver::Scenario scenario = scene(0.3, 0.1);
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
  driver::Scenario scenario = scene(10.0, 0.0);
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
  driver::Scenario scenario =
      test::needle_scenario({cells, cells, cells, Vec3(edge, edge, edge), 0.0});
  scenario.tissue.materials = {{5000.0, poisson, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed = {{"x1", 7}};
  scenario.time.analysis = driver::Analysis::equilibrium;
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

/// The block in two layers with their border at x = 3 cm.
driver::Scenario layered()
{
  driver::Scenario scenario = test::needle_scenario({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.0});
  mesh::Mesh& mesh = scenario.mesh;
  mesh.volumes = {"soft", "stiff"};
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto corner = mesh::corners(mesh, t);
    const double x = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]).x();
    mesh.region[static_cast<std::size_t>(t)] = x > 0.03 ? 1 : 0;
  }
  scenario.tissue.materials = {{5000.0, 0.4, 1000.0, 0.0, 0.02}, {20000.0, 0.4, 1000.0, 0.0, 0.02}};
  scenario.insertion.friction = {{{1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}},
                                 {{4.0, 4.0, 0.0}, {4.0, 4.0, 0.0}}};
  scenario.insertion.tip.cutting = {0.05, 0.2};
  scenario.needles[0].motion.depth = 0.05;
  scenario.time.end = 3.0;
  return scenario;
}

/// The channel waits at x = 3 cm until the force reaches `threshold`, and then goes on.
void expect_stop_at_border(const driver::Scenario& scenario, double threshold)
{
  const test::Run run = test::run(scenario);
  int waiting = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const auto& state = run.states[n - 1].insertions[0];
    const bool at_border = state.tip.threshold == threshold && state.phase == Phase::inserted;
    if (!at_border) continue;
    ++waiting;
    EXPECT_NEAR(state.path.vertex.back().x(), 0.03, 1e-12);
    const double force = run.reports[n].needles[0].coupling.tip_force;
    EXPECT_LE(force, threshold + 1e-12);
    if (run.states[n].insertions[0].path.length() > state.path.length()) {
      EXPECT_NEAR(force, threshold, 1e-12);
    }
  }
  EXPECT_GT(waiting, 3);
  EXPECT_EQ(run.states.back().insertions[0].tip.punctures, 2);  // the surface and the border
  EXPECT_GT(run.states.back().insertions[0].path.vertex.back().x(), 0.035);
}

TEST(Layers, EachHasItsOwnThresholdCuttingForceAndFriction)
{
  driver::Scenario scenario = layered();
  scenario.insertion.puncture.volume = {0.1, 1.0};
  expect_stop_at_border(scenario, 1.0);
  const test::Run run = test::run(scenario);
  const auto& last = run.reports[120];
  const auto& state = run.states[120].insertions[0];
  ASSERT_GT(state.path.vertex.back().x(), 0.032);
  EXPECT_NEAR(last.needles[0].coupling.tip_force, 0.2, 1e-12);
}

TEST(Layers, ATaggedSurfaceInsideATissueIsAMembrane)
{
  driver::Scenario scenario = layered();
  mesh::Mesh& mesh = scenario.mesh;
  mesh::SurfaceGroup capsule;
  capsule.name = "capsule";
  for (const mesh::Tet& tet : mesh.tets)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      const mesh::Face face{tet[(opposite + 1) % 4], tet[(opposite + 2) % 4],
                            tet[(opposite + 3) % 4]};
      const bool on_border = std::all_of(face.begin(), face.end(), [&](int node) {
        return std::abs(mesh.x[static_cast<std::size_t>(node)].x() - 0.03) < 1e-9;
      });
      if (on_border) capsule.faces.push_back(face);
    }
  mesh.surfaces.push_back(capsule);
  mesh.volumes = {"soft"};
  std::fill(mesh.region.begin(), mesh.region.end(), 0);
  scenario.tissue.materials.resize(1);
  scenario.insertion.friction.resize(1);
  scenario.insertion.tip.cutting = {0.05};
  scenario.insertion.puncture.volume = {0.1};
  scenario.insertion.puncture.surface.assign(mesh.surfaces.size(), -1.0);
  scenario.insertion.puncture.surface.back() = 0.6;
  expect_stop_at_border(scenario, 0.6);
}

/// Lateral place of the tip, along the bevel's axis, after an insertion.
double deflection(double bevel, double roll, needle::Model model)
{
  driver::Scenario scenario = test::needle_scenario({8, 5, 5, Vec3(0.06, 0.04, 0.04), 0.0});
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.model = model;
  needle.section = {0.00015, 0.0, 5e10, 0.3};
  needle.bevel = bevel;
  needle.motion.roll = roll;
  scenario.insertion.friction = test::same({0.5, 0.5, 0.0});
  scenario.insertion.tip.cutting = {0.05};
  scenario.time.end = 2.0;
  const test::Run run = test::run(scenario);
  const Vec3 away = run.reports.back().needles[0].tip - Vec3(0, 0.0173, 0.0231);
  return away.dot(core::frame_along(Vec3::UnitX()).col(1));
}

TEST(Bevel, SteersAFlexibleNeedleAwayFromItsFace)
{
  const double straight = deflection(0.0, 0.0, needle::Model::beam);
  const double up = deflection(0.05, 0.0, needle::Model::beam);
  const double down = deflection(0.05, std::numbers::pi, needle::Model::beam);
  const double twice = deflection(0.1, 0.0, needle::Model::beam);
  EXPECT_LT(std::abs(straight), 0.3 * std::abs(up - straight));
  EXPECT_LT(up - straight, -1e-4);  // the face looks along the axis, the tip goes the other way
  EXPECT_NEAR(down - straight, -(up - straight), 0.1 * std::abs(up));
  EXPECT_NEAR((twice - straight) / (up - straight), 2.0, 0.3);
  EXPECT_NEAR(deflection(0.1, 0.0, needle::Model::rigid), 0.0, 1e-15);
}

// The tip cuts with the same force in every step that it goes on, and the work of cutting is that
// force times the way, at any step; when the base rests nothing is cut.
TEST(Bevel, CutsWithTheSameWorkAtAnyStep)
{
  double work[2];
  for (int k : {0, 1}) {
    driver::Scenario scenario = scene(0.0, 0.05);
    needle::NeedleSettings& needle = scenario.needles[0];
    needle.model = needle::Model::beam;
    needle.section = {0.0003, 0.0, 7e10, 0.3};
    needle.bevel = 1.5;
    needle.motion.depth = 0.03;
    needle.motion.hold = 1.0;
    scenario.time.analysis = driver::Analysis::equilibrium;
    scenario.time.step = k == 0 ? 0.05 : 0.025;
    scenario.time.end = 2.0;
    const test::Run run = test::run(scenario);
    work[k] = 0.0;
    for (std::size_t n = 1; n < run.states.size(); ++n) {
      const auto& coupling = run.reports[n].needles[0].coupling;
      work[k] -= coupling.cutting_work;
      if (run.states[n].t < 1.45 && run.states[n - 1].insertions[0].path.length() > 0.0) {
        EXPECT_NEAR(coupling.tip_force, 0.05, 1e-9);
      }
      if (run.states[n].t > 1.6) {
        EXPECT_NEAR(coupling.cutting_work, 0.0, 1e-9);
      }
    }
  }
  EXPECT_NEAR(work[0], 0.05 * 0.03, 0.3 * 0.05 * 0.03);
  EXPECT_NEAR(work[1], work[0], 0.03 * work[0]);
}

// Turned as a whole, and entered at an angle: the same punctures, depth and force.
TEST(Puncture, DoesNotDependOnHowTheBodyLies)
{
  Vec3 force = Vec3::Zero();
  double depth = 0.0;
  for (int turn = 0; turn < 4; ++turn) {
    driver::Scenario scenario = layered();
    scenario.insertion.puncture.volume = {0.1, 0.4};
    scenario.insertion.tip.radius = 0.012;
    needle::BaseMotion& motion = scenario.needles[0].motion;
    motion.direction = Vec3(1.0, 0.21, -0.13).normalized();
    const Vec3 axis = turn * Vec3(0.7, -0.4, 0.9);
    const core::Mat3 Q = core::rotation_exp(axis);
    const Vec3 shift = turn * Vec3(0.11, -0.07, 0.05);
    for (Vec3& x : scenario.mesh.x) x = Q * x + shift;
    motion.entry = Q * motion.entry + shift;
    motion.direction = Q * motion.direction;
    const test::Run run = test::run(scenario);
    EXPECT_EQ(run.states.back().insertions[0].tip.punctures, 2);
    const Vec3 mine = Q.transpose() * run.reports.back().needles[0].base.force;
    if (turn == 0) {
      force = mine;
      depth = run.reports.back().needles[0].depth;
      EXPECT_GT(depth, 0.04);
    }
    // The samples of the tip's support lie along the world's axes.
    EXPECT_LT((mine - force).norm(), 0.01 * force.norm());
    EXPECT_NEAR(run.reports.back().needles[0].depth, depth, 1e-5);
  }
}

TEST(Puncture, IsAskedForAgainAtAnotherPlace)
{
  driver::Scenario scenario = scene(0.2, 0.05);
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
  driver::Scenario scenario = scene(10.0, 0.0);
  scenario.insertion.tip.friction = 0.3;
  scenario.output.energy = true;
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
  const driver::EnergyAccount& e = run.states.back().energy;
  EXPECT_GT(e.friction, 0.2 * e.supplied);
  EXPECT_LT(std::abs(e.rest()), 0.15 * e.supplied);
}

}  // namespace
}  // namespace trocar
