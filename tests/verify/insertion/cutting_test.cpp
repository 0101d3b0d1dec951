#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/tip.hpp"

namespace trocar {
namespace {

using test::scene;

// The base pushes with τ · depth + f_cut while the tip cuts, with friction alone on the way out and
// back in through the open channel, and with both again from its end on.
TEST(Cutting, ForceActsWhileTheTipAdvancesAndNotInTheOpenChannel)
{
  step::Scene scenario = scene(0.0, 0.15);
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
  step::Scene scenario = scene(0.0, std::numeric_limits<double>::infinity());
  scenario.time.is_static = true;
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

}  // namespace
}  // namespace trocar
