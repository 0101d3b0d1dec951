#include <gtest/gtest.h>

#include <algorithm>

#include "support/scene.hpp"

// Steps of turning tissue with the factor of an earlier step against the same run that factors in
// every step.
namespace trocar {
namespace {

using core::Vec3;
using test::distorted;

/// A block sheared by 15 degrees within the run while a bending needle goes in.
step::Scene sheared()
{
  step::Scene scenario = test::needle_scenario(distorted);
  scenario.tissue.model = tissue::Model::corotational;
  const core::Csv ramp{"shear", {"time", "factor"}, {{0, 0}, {1, 1}}};
  scenario.tissue.boundary.displacements = {{"z1", Vec3(0.0105, 0, 0), ramp}};
  scenario.needles[0].model = needle::Model::beam;
  scenario.needles[0].section = {0.0003, 0.0, 2e10, 0.3};
  scenario.needles[0].motion.velocity = 0.03;
  scenario.insertion.friction = test::same({12.0, 8.0, 0.0});
  scenario.time.end = 1.0;
  return scenario;
}

/// Both runs; forces and displacements differ by no more than `tolerance` of their size.
void expect_equal_runs(step::Scene scenario, double lag, double tolerance)
{
  scenario.tissue.lag_tolerance = 0.0;
  const test::Run exact = test::run(scenario);
  scenario.tissue.lag_tolerance = lag;
  const test::Run lagged = test::run(scenario);
  EXPECT_EQ(exact.ledger.factorisations, exact.ledger.assemblies);
  EXPECT_LT(lagged.ledger.factorisations, exact.ledger.factorisations / 3);
  double force = 0.0, way = 0.0, force_error = 0.0, way_error = 0.0;
  for (std::size_t n = 0; n < exact.states.size(); ++n) {
    const auto& u = exact.states[n].tissue.u.value;
    if (u.size() > 0) {
      way = std::max(way, u.cwiseAbs().maxCoeff());
      way_error = std::max(way_error, (u - lagged.states[n].tissue.u.value).cwiseAbs().maxCoeff());
    }
    for (std::size_t i = 0; i < exact.reports[n].needles.size(); ++i) {
      const Vec3 a = exact.reports[n].needles[i].base.force;
      force = std::max(force, a.norm());
      force_error = std::max(force_error, (a - lagged.reports[n].needles[i].base.force).norm());
    }
    EXPECT_EQ(exact.reports[n].rows, lagged.reports[n].rows);
  }
  EXPECT_GT(way, 1e-4);
  EXPECT_LE(way_error, tolerance * way);
  EXPECT_LE(force_error, tolerance * force);
}

TEST(Lag, AnInsertionIntoShearedTissueIsTheSame)
{
  expect_equal_runs(sheared(), 1e-9, 1e-7);
  expect_equal_runs(sheared(), 1e-6, 1e-4);
}

TEST(Lag, RowsWhoseBoundFollowsAnotherAreTheSame)
{
  step::Scene scenario = sheared();
  scenario.needles[0].bevel = 0.5;
  scenario.insertion.tip.cutting = {0.1};
  scenario.insertion.puncture.volume = {0.05};
  expect_equal_runs(scenario, 1e-9, 1e-6);
}

TEST(Lag, SoftRowsAndTwoNeedlesAreTheSame)
{
  step::Scene scenario = sheared();
  scenario.insertion.friction = test::same({12.0, 8.0, 100.0});
  scenario.needles.push_back(scenario.needles[0]);
  scenario.needles[1].name = "second";
  scenario.needles[1].motion.entry = Vec3(0, 0.0271, 0.0129);
  expect_equal_runs(scenario, 1e-9, 1e-7);
}

TEST(Lag, TissueAloneIsTheSame)
{
  step::Scene scenario = sheared();
  scenario.needles.clear();
  expect_equal_runs(scenario, 1e-9, 1e-7);
}

TEST(Lag, AnEquilibriumIsTheSame)
{
  step::Scene scenario = sheared();
  scenario.time.is_static = true;
  scenario.needles[0].motion.inserted = 0.03;
  scenario.needles[0].motion.velocity = 0.0;
  scenario.time.step = 0.1;
  expect_equal_runs(scenario, 1e-9, 1e-6);
}

}  // namespace
}  // namespace trocar
