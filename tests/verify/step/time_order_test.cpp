#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "support/scene.hpp"

// Orders in time of smooth motion, with rows that couple a needle to the tissue.
namespace trocar {
namespace {

using core::Vec3;

constexpr double end = 0.1;

/// A block with a beam in it, no friction, pulled by a traction that begins and ends smoothly.
step::Scene pulled(double h, bool second_order, tissue::Model model)
{
  step::Scene scenario = test::needle_scenario({4, 3, 3, Vec3(0.06, 0.04, 0.04), 0.1});
  scenario.tissue.model = model;
  scenario.tissue.materials[0].rayleigh_stiffness = 0.002;
  scenario.time.second_order = second_order;
  scenario.time.newton_max = model == tissue::Model::linear ? 1 : 20;
  scenario.time.step = h;
  scenario.time.end = end;
  scenario.insertion.friction = test::same({0.0, 0.0, 0.0});
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.model = needle::Model::beam;
  needle.section = {0.0005, 0.0, 2e9, 0.3};
  needle.density = 2000.0;
  needle.motion.inserted = 0.03;
  needle.motion.velocity = 0.0;
  core::Csv curve;
  for (int k = 0; k <= 1024; ++k) {
    const double t = end * k / 1024;
    const double s = std::sin(2.0 * std::numbers::pi * t / end);
    curve.rows.push_back({t, s * s * s * s * (1.0 + t / end)});
  }
  scenario.tissue.boundary.tractions = {{"x1", Vec3(0, 300.0, 200.0), curve}};
  return scenario;
}

/// Displacements and the needle's tip at the end.
core::VecX answer(double h, bool second_order, tissue::Model model)
{
  const test::Run run = test::run(pulled(h, second_order, model));
  const step::State& last = run.states.back();
  core::VecX all(last.tissue.u.value.size() + 3);
  all << last.tissue.u.value, last.needles[0].shaft.tip();
  EXPECT_GT(run.reports.back().rows, 5);
  return all;
}

double difference(const core::VecX& a, const core::VecX& b)
{
  return std::sqrt(base::Comm(MPI_COMM_WORLD).sum((a - b).squaredNorm()));
}

TEST(TimeScheme, BackwardEulerIsOfOrderOneAndBdf2OfOrderTwo)
{
  for (const auto model : {tissue::Model::linear, tissue::Model::corotational}) {
    const core::VecX exact = answer(end / 1024, true, model);
    for (bool second_order : {false, true}) {
      std::vector<double> error;
      for (int steps : {64, 128, 256})
        error.push_back(difference(answer(end / steps, second_order, model), exact));
      const double order = std::log2(error[1] / error[2]);
      std::printf("[ time ] %s, %s: errors %.3g %.3g %.3g, order %.2f\n",
                  model == tissue::Model::linear ? "linear" : "corotational",
                  second_order ? "bdf2" : "backward Euler", error[0], error[1], error[2], order);
      EXPECT_NEAR(order, second_order ? 2.0 : 1.0, 0.2);
    }
  }
}

// Linear tissue: of backward Euler the first step has an operator of its own, of BDF2 the first
// three.
TEST(TimeScheme, TakesOneFactorMore)
{
  EXPECT_EQ(test::run(pulled(end / 8, false, tissue::Model::linear)).ledger.factorisations, 2);
  EXPECT_EQ(test::run(pulled(end / 8, true, tissue::Model::linear)).ledger.factorisations, 4);
}

}  // namespace
}  // namespace trocar
