#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/tip.hpp"

namespace trocar {
namespace {

using core::Vec3;
using test::scene;

/// Lateral place of the tip, along the bevel's axis, after an insertion.
double deflection(double bevel, double roll, needle::Model model)
{
  step::Scene scenario = test::needle_scenario({8, 5, 5, Vec3(0.06, 0.04, 0.04), 0.0});
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.model = model;
  needle.section = {0.00015, 0.0, 5e10, 0.3};
  needle.bevel = bevel;
  needle.motion.roll = roll;
  scenario.tissue.materials[0].young = 1e4;
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
    step::Scene scenario = scene(0.0, 0.05);
    needle::NeedleSettings& needle = scenario.needles[0];
    needle.model = needle::Model::beam;
    needle.section = {0.0003, 0.0, 7e10, 0.3};
    needle.bevel = 1.5;
    needle.motion.depth = 0.03;
    needle.motion.hold = 1.0;
    scenario.time.is_static = true;
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

}  // namespace
}  // namespace trocar
