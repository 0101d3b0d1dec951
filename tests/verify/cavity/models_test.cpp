#include <gtest/gtest.h>

#include <cmath>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using test::add_needle;
using test::press;
using test::solved;

// The three solvers of the frozen model find the same root; the linear model keeps the linear
// volume and misses the exact one by the square of the strain.
TEST(Models, FrozenSolversAgreeAndLinearIsOff)
{
  cavity::CavityReport exact;
  for (Solver solver : {Solver::exact, Solver::newton, Solver::proportional}) {
    step::Scene scenario = test::cavity_scenario(5, 3, Model::frozen, solver);
    press(scenario, 0.004);
    const step::StepReport report = solved(scenario);
    const cavity::CavityReport& one = report.cavities[0];
    EXPECT_LE(one.error, 1e-12);
    if (solver == Solver::exact) {
      exact = one;
      EXPECT_EQ(report.pressure_updates, 1);
    }
    EXPECT_NEAR(one.pressure, exact.pressure, 1e-9 * exact.pressure);
    if (solver == Solver::newton) {
      EXPECT_LE(report.pressure_updates, 5);
    }
    if (solver == Solver::proportional) {
      EXPECT_GT(report.pressure_updates, 5);
    }
  }
  std::vector<double> error;
  for (double depth : {0.002, 0.001}) {
    step::Scene scenario = test::cavity_scenario(5, 3, Model::linear);
    press(scenario, depth);
    const step::StepReport report = solved(scenario);
    EXPECT_EQ(report.linearisations, 1);
    error.push_back(report.cavities[0].error);
  }
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.3);
}

// Beside a needle the three models agree for small deformation, and volumes are kept.
TEST(WithNeedle, ModelsAgree)
{
  std::vector<double> pressure;
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    step::Scene scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    add_needle(scenario, 0.0053);
    scenario.insertion.friction = test::same({0.5, 0.4, 0.0});
    scenario.time.end = 0.5;
    const test::Run run = test::run(scenario);
    const auto& report = run.reports.back();
    pressure.push_back(report.cavities[0].pressure);
    EXPECT_GT(report.rows, 3);
    if (model != Model::linear) {
      EXPECT_LE(report.cavities[0].error, 1e-12);
    }
  }
  EXPECT_GT(std::abs(pressure[0]), 0.1);
  EXPECT_NEAR(pressure[1], pressure[0], 0.02 * std::abs(pressure[0]));
  EXPECT_NEAR(pressure[2], pressure[0], 0.02 * std::abs(pressure[0]));
}

}  // namespace
}  // namespace trocar
