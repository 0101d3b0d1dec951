#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scene.hpp"

namespace trocar {
namespace {

using insertion::Placement;
using test::distorted;
using test::plain;

bool all_slip(const insertion::InsertionState& state)
{
  return !state.points.empty() && std::none_of(state.points.begin(), state.points.end(),
                                               [](const auto& p) { return p.stuck; });
}

// F = τ · depth to round-off in every step in which all points slip, on any mesh and placement.
TEST(Friction, IsTauTimesDepthWheneverEverythingSlips)
{
  for (const auto& shape : {plain, distorted})
    for (const insertion::PlacementSettings& placement : {insertion::PlacementSettings{},
                                                          {Placement::crossings, 0.005, 0.0},
                                                          {Placement::spacing, 0.0047, 0.3},
                                                          {Placement::spacing, 0.012, 0.3},
                                                          {Placement::line}}) {
      step::Scene scenario = test::needle_scenario(shape);
      scenario.insertion.placement = placement;
      // One step advances 0.5 mm; τ ℓ W_kk is about 1 N/m * 0.01 m * 3e-3 m/N = 3e-5 m.
      scenario.needles[0].motion.velocity = 0.025;
      scenario.insertion.friction = test::same({1.0, 1.0, 0.0});
      scenario.time.end = 1.5;
      const test::Run run = test::run(scenario);
      int slipping = 0;
      for (std::size_t n = 1; n < run.states.size(); ++n) {
        if (!all_slip(run.states[n].insertions[0])) continue;
        ++slipping;
        const auto& needle = run.reports[n].needles[0];
        EXPECT_NEAR(needle.coupling.shaft_friction, 1.0 * needle.depth, 1e-9);
      }
      EXPECT_GT(slipping, 20);
    }
}

TEST(Friction, OnlyDissipates)
{
  step::Scene scenario = test::needle_scenario(distorted);
  scenario.tissue.model = tissue::Model::corotational;
  scenario.needles[0].motion.hold = 0.2;
  scenario.needles[0].motion.withdraw_velocity = 0.03;
  scenario.insertion.friction = test::same({14.0, 9.0, 0.0});
  scenario.time.end = 4.0;
  double worst = 0.0, total = 0.0;
  for (const auto& report : test::run(scenario).reports) {
    worst = std::max(worst, report.needles[0].coupling.friction_work);
    total += report.needles[0].coupling.friction_work;
  }
  EXPECT_LE(worst, 1e-12);
  EXPECT_LT(total, -1e-4);
}

// From rest a point holds up to the static limit, slipping it keeps the dynamic one: pulled out
// slowly, the needle breaks away at τ_s · depth and goes on at τ_d · depth.
TEST(Friction, BreaksAwayAtTheStaticLimit)
{
  step::Scene scenario = test::needle_scenario(plain);
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.inserted = motion.depth = 0.04;
  motion.withdraw_velocity = 0.001;
  scenario.insertion.friction = test::same({4.0, 2.0, 0.0});
  scenario.time.step = 0.01;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  double peak = 0.0;
  for (const auto& report : run.reports)
    peak = std::max(peak, -report.needles[0].coupling.shaft_friction);
  const auto& last = run.reports.back().needles[0];
  // Points break away one after another, so the sum peaks below the sum of the static limits.
  EXPECT_GT(peak, 1.2 * 2.0 * 0.04);
  EXPECT_LE(peak, 4.0 * 0.04 + 1e-9);
  ASSERT_TRUE(all_slip(run.states.back().insertions[0]));
  EXPECT_NEAR(-last.coupling.shaft_friction, 2.0 * last.depth, 1e-9);
}

// A dashpot per length: F = b v depth once the tissue moves no more, in proportion to velocity, and
// it relaxes when the needle stops.
TEST(Friction, ViscousForceFollowsVelocityAndRelaxes)
{
  double per_velocity = 0.0;
  for (double velocity : {0.002, 0.004}) {
    step::Scene scenario = test::needle_scenario(distorted);
    needle::BaseMotion& motion = scenario.needles[0].motion;
    motion.inserted = 0.03;
    motion.velocity = velocity;
    motion.depth = 0.031;
    motion.hold = 1e9;
    scenario.insertion.friction = test::same({0.0, 0.0, 200.0});
    scenario.time.step = 2e-5 / velocity;
    scenario.time.end = 0.0008 / velocity;
    const test::Run run = test::run(scenario);
    const auto& last = run.reports.back().needles[0];
    // The tissue still creeps after 0.8 mm, by a few per cent of the needle's speed.
    EXPECT_NEAR(last.coupling.shaft_friction / (200.0 * velocity * last.depth), 1.0, 0.1);
    if (per_velocity > 0.0) {
      EXPECT_NEAR(last.coupling.shaft_friction / velocity / per_velocity, 1.0, 0.1);
    }
    per_velocity = last.coupling.shaft_friction / velocity;
    for (const auto& report : run.reports)
      EXPECT_LE(report.needles[0].coupling.friction_work, 1e-15);
    scenario.time.end = 0.001 / velocity + 1.0;
    EXPECT_LT(std::abs(test::run(scenario).reports.back().needles[0].coupling.shaft_friction),
              0.01 * last.coupling.shaft_friction);
  }
}

// Static friction only: a point that slipped has no axial row, one at rest has; the rows of a step
// do not change while it is iterated.
TEST(Friction, MayBeStaticOnly)
{
  for (bool is_static : {false, true}) {
    step::Scene scenario = test::needle_scenario(plain);
    scenario.needles[0].model = needle::Model::beam;
    scenario.time.is_static = is_static;
    scenario.time.newton_max = 20;
    scenario.needles[0].motion.hold = 0.2;
    scenario.needles[0].motion.withdraw_velocity = 0.02;
    scenario.insertion.friction = test::same({5.0, 0.0, 0.0});
    scenario.time.end = 3.0;
    const test::Run run = test::run(scenario);
    EXPECT_EQ(run.reports[75].needles[0].coupling.shaft_friction, 0.0);  // advancing: all slip
    double peak = 0.0;
    for (const auto& report : run.reports)
      peak = std::max(peak, -report.needles[0].coupling.shaft_friction);
    EXPECT_GT(peak, 0.01);  // from rest it holds first
  }
}

TEST(Friction, MayDifferOnWithdrawal)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.insertion.friction = {{{2.0, 2.0, 0.0}, {0.5, 0.5, 0.0}}};
  scenario.needles[0].motion.withdraw_velocity = 0.02;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  int slipping = 0;
  for (std::size_t n = 110; n < run.states.size(); ++n) {
    if (!all_slip(run.states[n].insertions[0])) continue;
    ++slipping;
    const auto& needle = run.reports[n].needles[0];
    EXPECT_NEAR(needle.coupling.shaft_friction, -0.5 * needle.depth, 1e-9);
  }
  EXPECT_GT(slipping, 20);
}

TEST(Friction, EtaIsThatPartOfSticking)
{
  // One point, one step: λ_η = η λ_stick with the lateral forces held; they shift it a little.
  const auto axial = [](double eta) {
    step::Scene scenario = test::needle_scenario(plain);
    scenario.needles[0].motion.inserted = 0.004;
    scenario.insertion.placement = {Placement::spacing, 0.005, 0.3};
    scenario.insertion.eta = eta;
    scenario.time.end = 0.02;
    return test::run(scenario).reports.back().needles[0].coupling.shaft_friction;
  };
  const double stick = axial(1.0 - 1e-12);
  EXPECT_GT(stick, 1e-3);
  EXPECT_NEAR(axial(0.3), 0.3 * stick, 0.1 * 0.3 * stick);
}

}  // namespace
}  // namespace trocar
