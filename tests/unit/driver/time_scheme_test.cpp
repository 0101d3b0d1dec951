#include <gtest/gtest.h>

#include "support/scene.hpp"

namespace trocar::driver {
namespace {

/// A block that nothing holds, in free fall.
Scenario falling(bool second_order)
{
  Scenario scenario = test::needle_scenario({2, 2, 2, Vec3(0.04, 0.04, 0.04), 0.1});
  scenario.needles.clear();
  scenario.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed.clear();
  scenario.tissue.boundary.gravity = Vec3(0, 0, -10);
  scenario.time.second_order = second_order;
  return scenario;
}

/// Height and velocity of a node that falls, and the scheme's past of them.
struct Fall
{
  double z = 0.0, v = 0.0, h = 0.0;  ///< [m], [m/s], [s] of the step that led here
  double z_before = 0.0, v_before = 0.0;

  /// One step of BDF2 from an extrapolated past, written for one number; of backward Euler when
  /// there is no past, or the step is more than twice as long as that before.
  void step(double now, bool second_order)
  {
    const double r = h > 0.0 ? now / h : 0.0;
    const bool two = second_order && h > 0.0 && r <= 2.0;
    const double lead = two ? (1.0 + 2.0 * r) / (1.0 + r) : 1.0;
    const double c = two ? r * r / (1.0 + 2.0 * r) : 0.0;
    const double z_past = z + c * (z - z_before), v_past = v + c * (v - v_before);
    z_before = z;
    v_before = v;
    v = v_past - 10.0 * now / lead;
    z = z_past + v * now / lead;
    h = now;
  }
};

// Steps that grow and shrink, one of them by more than twice.
TEST(TimeSteps, OfEveryLengthAreThoseOfTheScheme)
{
  for (bool second_order : {false, true}) {
    const Scenario scenario = falling(second_order);
    Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
    State state = *simulation.initial_state().state;
    Fall fall;
    double t = 0.0;
    for (double h : {0.01, 0.01, 0.015, 0.03, 0.07, 0.01}) {
      t += h;
      const StepResult result = simulation.step(state, {t, h, false});
      ASSERT_TRUE(result.state) << result.why;
      state = *result.state;
      fall.step(h, second_order);
      for (int i = 0; i < simulation.space().owned(); ++i) {
        EXPECT_NEAR(state.tissue.u.node(i).z(), fall.z, 1e-10) << t;
        EXPECT_NEAR(state.tissue.v.node(i).z(), fall.v, 1e-8) << t;
      }
      EXPECT_EQ(state.t, t);
      EXPECT_EQ(state.before.has_value(), second_order);
    }
  }
}

TEST(TimeSteps, OfStaticsTakeNoTime)
{
  EXPECT_EQ(core::TimeStep({1.0, 0.25, true}).inverse(), 0.0);
  EXPECT_EQ(core::TimeStep({1.0, 0.25, false}).inverse(), 4.0);
  EXPECT_EQ(core::TimeStep({1.0, 0.25, false, 1.0, 1.5}).inverse(), 6.0);
}

// The old state is a value: what is tried from it does not touch it.
TEST(TimeSteps, LeaveTheOldStateAlone)
{
  const Scenario scenario = falling(true);
  Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const State start = *simulation.initial_state().state;
  const State one = *simulation.step(start, {0.01, 0.01, false}).state;
  const core::VecX u = one.tissue.u.value;
  simulation.step(one, {0.02, 0.01, false});
  EXPECT_EQ(one.tissue.u.value, u);
  EXPECT_EQ(start.tissue.u.value, core::VecX::Zero(start.tissue.u.value.size()));
  EXPECT_FALSE(start.before.has_value());
}

}  // namespace
}  // namespace trocar::driver
