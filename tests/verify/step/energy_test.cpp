#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// A block without needle, held at x0, that a traction or moving support loads.
step::Scene bare(bool is_static)
{
  step::Scene scenario = test::needle_scenario({4, 2, 2, Vec3(0.06, 0.03, 0.03), 0.2});
  scenario.needles.clear();
  scenario.tissue.boundary.fixed = {{"x0", 7}};
  scenario.time.is_static = is_static;
  scenario.energy = true;
  return scenario;
}

// A linear body stretched in n equal static steps takes f·Δu at the end forces: what is supplied is
// (n+1)/n times what is stored, so the rest is the stored energy over n, exactly.
TEST(Energy, RestOfAStaticPathIsTheEndpointRulesError)
{
  step::Scene scenario = bare(true);
  scenario.tissue.boundary.displacements = {
      {"x1", Vec3(0.003, 0.0, 0.0), core::parse_csv("time,factor\n0,0\n1,1\n", "ramp.csv")}};
  for (int steps : {1, 4}) {
    scenario.time.step = 1.0 / steps;
    scenario.time.end = 1.0;
    const step::EnergyAccount e = test::run(scenario).states.back().energy;
    EXPECT_GT(e.elastic, 1e-5);
    EXPECT_NEAR(e.rest(), e.elastic / steps, 1e-9 * e.elastic);
    EXPECT_NEAR(e.supplied, e.elastic * (steps + 1) / steps, 1e-9 * e.elastic);
  }
}

// A body let go under its weight: backward Euler loses energy, never makes any, and half the loss
// with half the step; Rayleigh damping is counted apart.
TEST(Energy, BackwardEulerOnlyLosesAndLessWithSmallerSteps)
{
  step::Scene scenario = bare(false);
  scenario.tissue.boundary.gravity = Vec3(0, 0, -9.81);
  scenario.tissue.materials[0].rayleigh_stiffness = 0.0005;
  scenario.time.end = 0.02;
  double rest[2];
  for (int i : {0, 1}) {
    scenario.time.step = i == 0 ? 2e-4 : 1e-4;
    const test::Run run = test::run(scenario);
    double last = 0.0;
    for (const step::State& state : run.states) {
      EXPECT_GE(state.energy.rest(), last - 1e-15);
      last = state.energy.rest();
    }
    rest[i] = last;
    EXPECT_GT(run.states.back().energy.kinetic, 1e-6);
    EXPECT_GT(run.states.back().energy.damping, 1e-8);
  }
  EXPECT_NEAR(rest[1] / rest[0], 0.5, 0.05);
}

// An insertion with friction and cutting: what the holder puts in is found again, in the tissue, in
// the beam, as heat of friction and cutting; dissipation never falls.
TEST(Energy, HoldersWorkIsFoundAgain)
{
  step::Scene scenario = test::needle_scenario({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.2});
  scenario.needles[0].model = needle::Model::beam;
  scenario.insertion.tip.cutting = {0.1};
  scenario.energy = true;
  scenario.time.end = 1.5;
  scenario.time.step = 0.005;
  const test::Run run = test::run(scenario);
  const step::EnergyAccount& e = run.states.back().energy;
  EXPECT_GT(e.supplied, 5e-3);
  EXPECT_GT(e.friction, 1e-3);
  EXPECT_GT(e.cutting, 1e-3);
  EXPECT_LT(std::abs(e.rest()), 0.03 * e.supplied);
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    EXPECT_GE(run.states[n].energy.friction, run.states[n - 1].energy.friction - 1e-15);
    EXPECT_GE(run.states[n].energy.cutting, run.states[n - 1].energy.cutting - 1e-15);
  }
}

TEST(Energy, IsNotKeptUnlessAsked)
{
  step::Scene scenario = bare(false);
  scenario.energy = false;
  scenario.tissue.boundary.gravity = Vec3(0, 0, -9.81);
  scenario.time.end = 0.1;
  EXPECT_EQ(test::run(scenario).states.back().energy.supplied, 0.0);
}

// A needle in the air, rolled faster and faster: its holder's moment does the work that sets it
// going. With n equal gains of speed, by the ends of the steps, (n + 1)/n of the energy of motion
// and twice the first gain, which comes about within half a step.
TEST(Energy, TurningANeedleTakesItsEnergyOfMotion)
{
  step::Scene scenario = test::needle_scenario(test::plain);
  scenario.energy = true;
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.motion.entry.x() = -0.01;
  needle.density = 7850.0;
  needle.section.outer = 0.002;
  const int n = 20;
  scenario.time.step = 0.01;
  scenario.time.end = 0.01 * n;
  core::Csv rolls{"roll.csv", {"time", "x", "y", "z", "dx", "dy", "dz", "roll"}, {}};
  const Vec3 base = needle.motion.entry - Vec3(needle.motion.length, 0.0, 0.0);
  for (int k = 0; k <= n; ++k)
    rolls.rows.push_back(
        {0.01 * k, base.x(), base.y(), base.z(), 1.0, 0.0, 0.0, 0.005 * k * (k + 1)});
  needle.motion.trajectory = rolls;
  const step::EnergyAccount e = test::run(scenario).states.back().energy;
  const double pi = std::numbers::pi, r = 0.002;
  const double inertia = 0.5 * 7850.0 * pi * r * r * needle.motion.length * r * r;
  const double rate = n * 0.01 / 0.01;
  EXPECT_NEAR(e.kinetic, 0.5 * inertia * rate * rate, 1e-9 * inertia * rate * rate);
  EXPECT_NEAR(e.supplied / e.kinetic, (n * (n + 1.0) + 2.0) / (n * n), 1e-6);
}

}  // namespace
}  // namespace trocar
