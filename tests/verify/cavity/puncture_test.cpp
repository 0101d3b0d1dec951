#include <gtest/gtest.h>

#include <cmath>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using core::Vec3;
using test::add_needle;

// The tip comes through the wall: the leak opens, pressure and volume fall, no rows in the void;
// after withdrawal the hole goes on leaking with its own resistance.
TEST(WallPuncture, OpensTheEdge)
{
  step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
  add_needle(scenario, 0.0253);
  scenario.time.end = 2.4;
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.velocity = 0.02;
  motion.depth = 0.025;
  motion.hold = 0.2;
  motion.withdraw_velocity = 0.03;
  scenario.cavities.cavities[0].initial_pressure = 1000.0;
  scenario.cavities.cavities[0].alarm = 300.0;
  scenario.time.start_in_equilibrium = true;
  cavity::ConduitSettings leak;
  leak.name = "leak";
  leak.from = 0;
  leak.needle = 0;
  leak.needle_radius = 0.0005;
  leak.gap = 2e-4;
  leak.hole_resistance = 1e8;
  scenario.cavities.conduits = {leak};
  const test::Run run = test::run(scenario);
  const double V0 = 2.7e-5;
  bool was_in = false, was_out = false, alarmed = false;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const cavity::ConduitState& conduit = run.states[n].cavities.conduit[0];
    const double p = run.reports[n].cavities[0].pressure;
    const double first = run.reports[0].cavities[0].volume;
    EXPECT_NEAR(first - run.reports[n].cavities[0].volume, conduit.moved, 2e-12 * V0);
    if (!conduit.pierced) {
      EXPECT_EQ(conduit.flow, 0.0);
      continue;
    }
    const double gap =
        6.0 * 1e-3 * conduit.channel / (std::acos(-1.0) * 0.0005 * std::pow(2e-4, 3));
    EXPECT_NEAR(conduit.channel, 0.01, 0.002);
    EXPECT_NEAR(conduit.flow, p / (conduit.needle_in ? gap : 1e8), 1e-9 * conduit.flow);
    was_in = was_in || conduit.needle_in;
    was_out = was_out || (was_in && !conduit.needle_in);
    alarmed = alarmed || run.reports[n].cavities[0].alarm;
    // In the void the shaft holds nothing: points stand in the first centimetre only.
    for (const auto& point : run.states[n].insertions[0].points)
      EXPECT_LT(run.states[n].insertions[0].path.sites[static_cast<std::size_t>(point.site)].arc,
                0.0101);
  }
  EXPECT_TRUE(was_in && was_out && alarmed);
  EXPECT_LT(run.reports.back().cavities[0].pressure, 600.0);
}

// A needle that is through both walls at the start has opened its conduit.
TEST(WallPuncture, NeedleThroughTheCavityAtTheStart)
{
  step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
  add_needle(scenario, 0.0253);
  scenario.needles[0].motion.inserted = 0.045;
  scenario.needles[0].motion.velocity = 0.0;
  scenario.needles[0].motion.length = 0.1;
  scenario.time.end = 0.04;
  scenario.time.start_in_equilibrium = true;
  scenario.cavities.cavities[0].initial_pressure = 500.0;
  cavity::ConduitSettings leak;
  leak.name = "leak";
  leak.from = 0;
  leak.needle = 0;
  leak.resistance = 1e9;
  scenario.cavities.conduits = {leak};
  const test::Run run = test::run(scenario);
  EXPECT_TRUE(run.states.back().cavities.conduit[0].needle_in);
  EXPECT_NEAR(run.states.back().cavities.conduit[0].channel, 0.01, 1e-3);
  EXPECT_GT(run.states.back().cavities.conduit[0].flow, 0.0);
}

// Two cavities in a row: a conduit between them opens when the needle has come into the second one.
TEST(WallPuncture, ASeptumHoldsUntilItIsPierced)
{
  step::Scene scenario = test::cavity_scenario(5, 1, Model::linear);
  test::BlockShape shape{7, 5, 5, Vec3(0.07, 0.05, 0.05)};
  const auto in = [](const Vec3& x, double at) {
    return (x - Vec3(at, 0.025, 0.025)).cwiseAbs().maxCoeff() < 0.0051;
  };
  shape.hole = [&](const Vec3& x) { return in(x, 0.015) || in(x, 0.045); };
  scenario.mesh = test::block(shape);
  test::add_surface(scenario.mesh, "wall", [&](const Vec3& x) { return in(x, 0.015); });
  test::add_surface(scenario.mesh, "other", [&](const Vec3& x) { return in(x, 0.045); });
  cavity::CavitySettings other = scenario.cavities.cavities[0];
  other.name = other.surface = "other";
  scenario.cavities.cavities.push_back(other);
  add_needle(scenario, 0.0253);
  scenario.needles[0].motion.entry.z() = 0.0243;
  scenario.needles[0].motion.velocity = 0.05;
  scenario.needles[0].motion.depth = 0.045;
  scenario.needles[0].motion.length = 0.12;
  cavity::ConduitSettings bridge;
  bridge.name = "bridge";
  bridge.from = 0;
  bridge.to = 1;
  bridge.needle = 0;
  bridge.resistance = 1e9;
  scenario.cavities.conduits = {bridge};
  const test::Run run = test::run(scenario);
  bool opened = false;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double depth = run.states[n].needles[0].shaft.tip().x();
    const bool pierced = run.states[n].cavities.conduit[0].pierced;
    if (depth < 0.039) {
      EXPECT_FALSE(pierced) << depth;
    }
    opened = opened || pierced;
  }
  EXPECT_TRUE(opened);
}

}  // namespace
}  // namespace trocar
