#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using core::Vec3;

/// A plate on the top, moved by two curves: down along z, sideways along x.
step::Scene moved_plate(Model model, const std::string& down, const std::string& sideways)
{
  constexpr double open = std::numeric_limits<double>::quiet_NaN();
  step::Scene scenario = test::cavity_scenario(5, 3, model, Solver::exact);
  scenario.time.step = 1.0;
  scenario.tissue.boundary.displacements = {
      {"z1", Vec3(open, 0.0, -0.006), core::parse_csv("time,factor\n" + down, "down")},
      {"z1", Vec3(0.006, open, open), core::parse_csv("time,factor\n" + sideways, "sideways")}};
  return scenario;
}

/// Work of the plate round the triangle (0,0), (1,0), (1,1) of its two motions, `n` steps a side.
double loop_work(Model model, int n)
{
  step::Scene scenario = moved_plate(model, "0,0\n1,1\n2,1\n3,0\n", "0,0\n1,0\n2,1\n3,0\n");
  scenario.time.step = 1.0 / n;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  double work = 0.0;
  const auto at = [&](int k, std::size_t tool) {
    const auto& one = scenario.tissue.boundary.displacements[tool];
    return 0.006 * core::interpolate(*one.curve, 1, static_cast<double>(k) / n);
  };
  for (int k = 1; k <= 3 * n; ++k) {
    const auto force = [&](std::size_t tool, int axis) {
      return 0.5 * (run.reports[static_cast<std::size_t>(k)].holders.tools[tool][axis] +
                    run.reports[static_cast<std::size_t>(k - 1)].holders.tools[tool][axis]);
    };
    work += -force(0, 2) * (at(k, 0) - at(k - 1, 0)) + force(1, 0) * (at(k, 1) - at(k - 1, 1));
  }
  return work;
}

// The follower model has an energy: round a closed path nothing is gained, but for the sum's own
// error, which falls as h². Frozen loads have none: something stays.
TEST(CavityEnergy, ClosedPathOfATool)
{
  const double coarse = loop_work(Model::follower, 4), fine = loop_work(Model::follower, 8);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  const double frozen = loop_work(Model::frozen, 8), finer = loop_work(Model::frozen, 16);
  std::printf("[ closed path ] follower %.3g, %.3g J; frozen %.3g, %.3g J\n", coarse, fine, frozen,
              finer);
  EXPECT_GT(std::abs(finer), 20.0 * std::abs(loop_work(Model::follower, 16)));
}

// Stiffness that a tool feels is symmetric with follower pressures; how far frozen ones are off is
// measured.
TEST(CavityEnergy, ToolStiffnessIsSymmetric)
{
  const double d = 0.01;
  for (Model model : {Model::follower, Model::frozen}) {
    const auto force = [&](double down, double sideways) {
      // Twice the same equilibrium: the second one starts from the first and polishes it.
      step::Scene scenario = moved_plate(model, "0,0\n1,1\n2,1\n", "0,0\n1,1\n2,1\n");
      scenario.time.end = 2.0;
      scenario.tissue.boundary.displacements[0].value.z() *= down;
      scenario.tissue.boundary.displacements[1].value.x() *= sideways;
      const std::vector<Vec3> tools = test::run(scenario).reports.back().holders.tools;
      return Eigen::Vector2d(-tools[0].z(), tools[1].x());
    };
    const auto slope = [&](const Eigen::Vector2d& way) -> Eigen::Vector2d {
      const auto at = [&](double s) { return force(0.8 + s * way[0], 0.6 + s * way[1]); };
      return (8.0 * (at(d) - at(-d)) - (at(2 * d) - at(-2 * d))) / (12.0 * d);
    };
    const Eigen::Vector2d a = slope({1, 0}), b = slope({0, 1});
    const double asymmetry = std::abs(a[1] - b[0]) / std::max(a.norm(), b.norm());
    std::printf("[ tool stiffness ] %s: across %.6g and %.6g of %.6g N/m, asymmetry %.2g\n",
                model == Model::follower ? "follower" : "frozen", a[1] / 0.006, b[0] / 0.006,
                a.norm() / 0.006, asymmetry);
    if (model == Model::follower) {
      EXPECT_LE(asymmetry, 1e-9);
    } else {
      EXPECT_GT(asymmetry, 1e-5);
    }
  }
}

}  // namespace
}  // namespace trocar
