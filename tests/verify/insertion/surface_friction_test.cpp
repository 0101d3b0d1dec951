#include <gtest/gtest.h>

#include <cmath>

#include "support/tip.hpp"

namespace trocar {
namespace {

using core::Vec3;
using insertion::TipOutcome;

constexpr double mu = 0.3;
constexpr int presses = 10, draws = 40;
constexpr double stride = 1e-4;  ///< of the drawing [m]

/// A tip pressed 2 mm deep into a surface that it cannot puncture, and then drawn along it, in one
/// equilibrium after the other.
test::Run drawn(const Vec3& aside)
{
  step::Scene scenario = test::needle_scenario({6, 6, 6, Vec3(0.06, 0.06, 0.06), 0.0});
  scenario.tissue.boundary.fixed = {{"x1", 7}};
  scenario.time.is_static = true;
  scenario.time.step = 1.0;
  scenario.time.end = presses + draws;
  scenario.insertion.puncture.volume = {1e3};
  scenario.insertion.tip = {{0.0}, 0.012, mu};
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.entry = Vec3(0.0, 0.0312, 0.0294);
  const Vec3 start = motion.entry - Vec3(motion.length, 0.0, 0.0);
  const Vec3 pressed = start + Vec3(0.002, 0.0, 0.0), end = pressed + draws * stride * aside;
  const auto row = [](double t, const Vec3& x) {
    return std::vector<double>{t, x.x(), x.y(), x.z()};
  };
  motion.trajectory =
      core::Csv{"aside",
                {"time", "x", "y", "z"},
                {row(0.0, start), row(presses, pressed), row(scenario.time.end, end)}};
  return test::run(scenario);
}

// What the holder feels: the tissue gives way in proportion to the travel until the lateral force
// is μ times the axial one, and from there on the tip slides with just that force.
TEST(SurfaceFriction, HoldsUpToCoulombsForceAndSlidesWithIt)
{
  const core::Mat3 frame = core::frame_along(Vec3::UnitX());
  // Along the needle's own normals and between them: friction has no preferred direction.
  for (const Vec3& aside : {Vec3(frame.col(1)), Vec3(frame.col(2)),
                            Vec3((frame.col(1) + frame.col(2)) / std::sqrt(2.0))}) {
    const test::Run run = drawn(aside);
    const auto force = [&](int n) -> Vec3 {
      return run.reports[static_cast<std::size_t>(n)].needles[0].base.force;
    };
    const double before = force(presses).dot(aside);
    const double stiffness = (force(presses + 1).dot(aside) - before) / stride;
    EXPECT_GT(force(presses).x(), 0.1);
    int sticking = 0, sliding = 0;
    for (int n = presses + 1; n <= presses + draws; ++n) {
      const double lateral = force(n).dot(aside), most = mu * force(n).x();
      const double held = before + stiffness * stride * (n - presses);
      const auto& coupling = run.reports[static_cast<std::size_t>(n)].needles[0].coupling;
      if (coupling.tip == TipOutcome::slides) {
        EXPECT_NEAR(force(n).tail<2>().norm(), most, 1e-6 * most) << n;
        EXPECT_GT(lateral, 0.99 * most) << n;
        if (sliding++ == 0) {
          EXPECT_GT(held, most);
        }
      } else {
        EXPECT_LT(lateral, most) << n;
        EXPECT_NEAR(lateral, held, 1e-6 * most) << n;
        EXPECT_EQ(sliding, 0) << "slides and sticks again";
        ++sticking;
      }
    }
    EXPECT_GT(sticking, 3);
    EXPECT_GT(sliding, 10);
  }
}

}  // namespace
}  // namespace trocar
