#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scene.hpp"

// Steps in which a needle bends or turns a lot: how often they are linearised, and what holds a
// needle that has hardly come in.
namespace trocar {
namespace {

using core::Vec3;

/// A beam 4 cm deep in the block, whose base goes 1 cm sideways in four steps.
step::Scene sideways(tissue::Model model, double young)
{
  step::Scene scenario = test::needle_scenario(test::plain);
  scenario.tissue.model = model;
  scenario.tissue.lag_tolerance = 1e-8;
  scenario.tissue.materials = {{young, 0.4, 1e-3, 0.0, 0.0}};
  scenario.needles[0].model = needle::Model::beam;
  scenario.needles[0].section = {0.0005, 0.0, 2e10, 0.3};
  scenario.needles[0].motion.length = 0.07;
  scenario.needles[0].motion.inserted = 0.04;
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.03,0.0173,0.0231\n1,-0.03,0.0273,0.0231\n", "aside.csv");
  scenario.insertion.friction = test::same({3.0, 2.0, 0.0});
  scenario.time.step = 0.25;
  scenario.time.end = 1.0;
  return scenario;
}

// A needle may be far from balance where the tissue is not: linear tissue always is balanced, and
// stiff tissue hardly notices. Then the step is linearised again all the same.
TEST(BeamSteps, AreLinearisedUntilTheNeedleIsBalancedToo)
{
  for (const auto& [model, young] : {std::pair{tissue::Model::linear, 5e4},
                                     {tissue::Model::corotational, 5e4},
                                     {tissue::Model::corotational, 5e8}}) {
    step::Scene scenario = sideways(model, young);
    const test::Run automatic = test::run(scenario);
    scenario.time.newton_max = 50;
    const test::Run iterated = test::run(scenario);
    for (std::size_t n = 1; n < iterated.reports.size(); ++n) {
      const Vec3 wanted = iterated.reports[n].needles[0].base.force;
      EXPECT_LT((automatic.reports[n].needles[0].base.force - wanted).norm(), 2e-3 * wanted.norm())
          << "step " << n << " in tissue of " << young << " Pa";
      const bool once = automatic.reports[n].linearisations == 1;
      EXPECT_LE(automatic.reports[n].unbalanced, once ? 1e-3 : 1e-6);
    }
    scenario.time.newton_max = 1;
    EXPECT_GT(test::run(scenario).reports.back().unbalanced, 0.01);  // it says so
  }
}

// A needle that goes in straight bends little: one linearisation does.
TEST(BeamSteps, AreLinearisedOnceWhereThatDoes)
{
  for (const needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    step::Scene scenario = test::needle_scenario(test::distorted);
    scenario.needles[0].model = model;
    scenario.time.end = 1.0;
    for (const step::StepReport& report : test::run(scenario).reports)
      EXPECT_LE(report.linearisations, 1) << report.unbalanced;
  }
}

// A slender block that buckles: where the exact tangent has no factor the rotated one goes on, with
// the factor of an earlier step as with its own.
TEST(Tangent, WithoutAFactorIsDroppedBesideAnOlderFactorToo)
{
  for (double lag : {0.0, 1e-8}) {
    test::BlockShape shape{8, 2, 2, Vec3(0.08, 0.02, 0.02), 0.0};
    shape.quadratic = true;
    step::Scene scenario = test::needle_scenario(shape);
    scenario.needles.clear();
    scenario.tissue.model = tissue::Model::corotational;
    scenario.tissue.lag_tolerance = lag;
    scenario.tissue.materials = {{15000.0, 0.4, 1000.0, 0.0, 0.0}};
    scenario.tissue.boundary.fixed = {{"x0", 7}};
    scenario.tissue.boundary.displacements = {
        {"x1", Vec3(-0.01, 0, 1e-4), core::parse_csv("time,factor\n0,0\n3,1\n", "press.csv")}};
    scenario.time.is_static = true;
    scenario.time.step = 0.25;
    scenario.time.end = 1.0;
    EXPECT_NO_THROW(test::run(scenario)) << "lag " << lag;
  }
}

/// Moment that turns a rigid needle about the place where it entered, by 0.01: its path stays
/// straight, and every point holds it.
double turned(double depth, insertion::Placement placement)
{
  step::Scene scenario = test::needle_scenario({4, 4, 4, Vec3(0.2, 0.2, 0.2), 0.0});
  const Vec3 entry(0, 0.1093, 0.0907);
  const double behind = 0.08 - depth;
  scenario.needles[0].motion.entry = entry;
  scenario.needles[0].motion.inserted = depth;
  const std::string x = std::to_string(-behind) + ",0.1093,";
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z,dx,dy,dz\n0," + x + "0.0907,1,0,0\n1," + x +
                          std::to_string(entry.z() + 0.1 * behind) + ",1,0,-0.1\n",
                      "turn.csv");
  scenario.insertion.friction = test::same({3.0, 2.0, 0.0});
  scenario.insertion.placement.placement = placement;
  scenario.insertion.placement.spacing = 0.002;
  scenario.time.is_static = true;
  scenario.time.step = 0.1;
  scenario.time.end = 0.1;
  const test::Run run = test::run(scenario);
  const needle::Wrench& base = run.reports.back().needles[0].base;
  const Vec3 arm = run.states.back().needles[0].shaft.x.front() - entry;
  return (base.moment + arm.cross(base.force)).y();
}

// Within the first half of the mean edge of a coarse tet (32 mm) as well a needle is held against
// turning, as a stiff line of its length is: by k a³/3 for each radian, k = 8πμ(1 - ν)/(3 - 4ν), a
// the half, the quarter or the eighth of that half edge that the tip has passed last; divided by
// 1 - a/half, so that at the half edge the tet alone holds it, a thousand times harder than a line
// of an eighth of it would.
TEST(Lever, HoldsANeedleThatHasHardlyComeIn)
{
  const double half = 0.5 * 0.05 * (3.0 + 2.0 * std::sqrt(2.0) + std::sqrt(3.0)) / 6.0;
  const double k = 8.0 * std::numbers::pi * (5000.0 / 2.8) * 0.6 / 1.4;
  for (const auto& [depth, part] : {std::pair{0.006, 0.125}, {0.012, 0.25}, {0.02, 0.5}}) {
    const double wanted = k * std::pow(part * half, 3) / 3.0 * 0.01 / (1.0 - part);
    const double held = turned(depth, insertion::Placement::crossings);
    EXPECT_GT(held, 0.9 * wanted) << depth;
    EXPECT_LT(held, 1.001 * wanted) << depth;
  }
  const double resolved = turned(0.034, insertion::Placement::crossings);
  const double everywhere = turned(0.034, insertion::Placement::spacing);
  EXPECT_GT(resolved, 0.3 * everywhere);
  EXPECT_LT(resolved, 1.01 * everywhere);
}

}  // namespace
}  // namespace trocar
