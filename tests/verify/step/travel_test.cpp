#include <gtest/gtest.h>

#include <cmath>

#include "support/tip.hpp"

namespace trocar {
namespace {

using core::Vec3;

// At constant velocity the travel is v t, also while the tip pushes the skin in and depth is 0; it
// goes back on withdrawal.
TEST(Travel, IsVelocityTimesTimeBeforeThePunctureAsWell)
{
  for (const needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    step::Scene scenario = test::scene(1e6, 0.0);
    needle::BaseMotion& motion = scenario.needles[0].motion;
    scenario.needles[0].model = model;
    motion.direction = Vec3(1.0, 0.1, -0.2).normalized();
    motion.depth = 0.01;
    motion.withdraw_velocity = 0.03;
    scenario.time.end = 0.8;
    const test::Run run = test::run(scenario);
    for (std::size_t n = 0; n < run.states.size(); ++n) {
      const double t = run.states[n].t;
      const double travel = t <= 0.5 ? 0.02 * t : 0.01 - 0.03 * (t - 0.5);
      EXPECT_NEAR(run.states[n].needles[0].travel, travel, 1e-14);
      EXPECT_EQ(run.reports[n].needles[0].depth, 0.0);
    }
    EXPECT_GT(run.reports[20].needles[0].coupling.tip_force, 0.0);  // the skin is pushed in
  }
}

/// Travel at the end of a run along a trajectory.
double along(const std::string& table, double end)
{
  step::Scene scenario = test::needle_scenario(test::plain);
  scenario.needles[0].model = needle::Model::beam;
  scenario.needles[0].motion.inserted = 0.01;
  scenario.needles[0].motion.trajectory = core::parse_csv(table, "path.csv");
  scenario.time.end = end;
  return test::run(scenario).states.back().needles[0].travel;
}

TEST(Travel, CountsOnlyWhatGoesAlongTheNeedle)
{
  EXPECT_NEAR(along("time,x,y,z\n0,-0.07,0.0173,0.0231\n1,-0.06,0.0183,0.0221\n", 1.0), 0.01,
              1e-14);
  EXPECT_NEAR(along("time,x,y,z\n0,-0.07,0.0173,0.0231\n1,-0.07,0.0193,0.0231\n", 1.0), 0.0, 1e-14);
  // Round a circle that the needle is tangent to: its arc, to the square of the step.
  std::string arc = "time,x,y,z,dx,dy,dz\n";
  constexpr double radius = 0.1, turn = 0.1;
  constexpr int steps = 10;
  for (int k = 0; k <= steps; ++k) {
    const double angle = turn * k / steps;
    arc += std::to_string(0.02 * k) + "," + std::to_string(-0.07 + radius * std::sin(angle)) + "," +
           std::to_string(0.0173 + radius * (1.0 - std::cos(angle))) + ",0.0231," +
           std::to_string(std::cos(angle)) + "," + std::to_string(std::sin(angle)) + ",0\n";
  }
  EXPECT_NEAR(along(arc, 0.02 * steps), radius * turn, 1e-3 * radius * turn);
}

// A value of the state: steps that are tried and dropped leave no trace in it.
TEST(Travel, OfADroppedStepDoesNotCount)
{
  const step::Scene scenario = test::needle_scenario(test::plain);
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  step::State state = step::initial_state(simulation)->state;
  for (int n = 1; n <= 3; ++n) {
    step::advance(simulation, state, {0.02 * n + 0.5, 0.52, false});
    state = step::advance(simulation, state, {0.02 * n, 0.02, false})->state;
  }
  EXPECT_NEAR(state.needles[0].travel, 0.02 * 0.06, 1e-15);
}

}  // namespace
}  // namespace trocar
