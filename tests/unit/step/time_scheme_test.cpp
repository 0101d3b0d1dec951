#include <gtest/gtest.h>

#include "support/scene.hpp"

namespace trocar::step {
namespace {

/// A block that nothing holds, in free fall.
Scene falling(bool second_order)
{
  Scene scenario = test::needle_scenario({2, 2, 2, Vec3(0.04, 0.04, 0.04), 0.1});
  scenario.needles.clear();
  scenario.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed.clear();
  scenario.tissue.boundary.gravity = Vec3(0, 0, -10);
  scenario.time.second_order = second_order;
  return scenario;
}

// Steps that grow and shrink, one of them by more than twice: constant acceleration is met without
// error in every velocity that the scheme takes for that at its own moment, the middle of the step
// with backward Euler, its end with BDF2.
TEST(TimeSteps, OfEveryLengthFallAsGalileiSays)
{
  for (bool second_order : {false, true}) {
    const Scene scenario = falling(second_order);
    Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
    State state = step::initial_state(simulation)->state;
    // Nothing is driven: as if a step of the first one's length had led to the start, and the fall
    // had begun half of it earlier.
    constexpr double earlier = 0.005;
    double t = 0.0, before = 0.0;

    for (double h : {0.01, 0.01, 0.015, 0.03, 0.07, 0.01}) {
      t += h;
      const Outcome<Accepted> result = step::advance(simulation, state, {t, h, false});
      ASSERT_TRUE(result) << result.why();
      state = result->state;
      const bool two = second_order && h <= 2.0 * before && h >= 0.2 * before;
      before = h;
      for (int i = 0; i < simulation.space.owned(); ++i) {
        EXPECT_NEAR(state.tissue.u.node(i).z(), -5.0 * t * (t + 2.0 * earlier), 1e-10) << t;
        EXPECT_NEAR(state.tissue.v.node(i).z(), -10.0 * (earlier + (two ? t : t - 0.5 * h)), 1e-8)
            << t;
      }
      EXPECT_EQ(state.t, t);
      EXPECT_EQ(state.before.has_value(), second_order);
    }
  }
}

TEST(TimeSteps, OfStaticsTakeNoTime)
{
  EXPECT_EQ(core::TimeStep({1.0, 0.25, true}).rates(), core::Rates{});
  EXPECT_EQ(core::TimeStep({1.0, 0.25, false}).rates(), (core::Rates{4.0, 4.0}));
  EXPECT_EQ(core::TimeStep({1.0, 0.25, false, 1.0, 1.5, 0.125}).rates(), (core::Rates{6.0, 8.0}));
}

// The old state is a value: what is tried from it does not touch it.
TEST(TimeSteps, LeaveTheOldStateAlone)
{
  const Scene scenario = falling(true);
  Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const State start = step::initial_state(simulation)->state;
  const State one = step::advance(simulation, start, {0.01, 0.01, false})->state;
  const core::VecX u = one.tissue.u.value;
  step::advance(simulation, one, {0.02, 0.01, false});
  EXPECT_EQ(one.tissue.u.value, u);
  EXPECT_EQ(start.tissue.u.value, core::VecX::Zero(start.tissue.u.value.size()));
  EXPECT_FALSE(start.before.has_value());
}

}  // namespace
}  // namespace trocar::step
