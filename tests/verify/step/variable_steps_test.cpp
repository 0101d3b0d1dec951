#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "support/cavity.hpp"

// Forces of constrained motion when the length of the steps changes: orders in time, every step
// looked at.
namespace trocar {
namespace {

using core::Vec3;

constexpr int finest = 1024;  ///< units of time to the end; all steps are whole numbers of them
constexpr double end = 0.1, unit = end / finest;

enum class Pattern { alternating, random, halved_once, quarters, eighths };

/// Steps of 1 or 2 times `least` units each; no step is more than twice as long as that before.
/// Quarters and eighths: 8 times `least`, some of them in parts, as the time stepper has them when
/// halves are rejected.
std::vector<int> pattern(Pattern kind, int least)
{
  std::vector<int> steps;
  std::mt19937 draw(7);
  std::vector<int> parts{8, 8, 8, 4, 2, 2, 8, 8, 4, 2, 1, 1, 8, 8};
  if (kind == Pattern::quarters) parts = {8, 8, 2, 2, 4, 8, 8, 4, 2, 2, 8, 8};
  for (int done = 0; done < finest; done += steps.back()) {
    const std::size_t n = steps.size();
    int next = 2;
    if (kind == Pattern::alternating) next = 1 + static_cast<int>(n % 2);
    if (kind == Pattern::random) next = 1 + static_cast<int>(draw() % 2);
    if (kind == Pattern::halved_once) next = n == 5 || n == 6 ? 1 : 2;
    if (kind == Pattern::quarters || kind == Pattern::eighths)
      next = n < parts.size() ? parts[n] : 8;
    steps.push_back(std::min(next * least, finest - done));
  }
  return steps;
}

core::Csv curve(const std::function<double(double)>& f)
{
  core::Csv table;
  for (int k = 0; k <= finest; ++k) table.rows.push_back({k * unit, f(k * unit)});
  return table;
}

/// Begins and ends smoothly.
double smooth(double t)
{
  const double s = std::sin(std::numbers::pi * t / end);
  return s * s * s * s * (1.0 + t / end);
}

/// What is looked at after every step, by the units of time that passed.
using Answer = std::function<double(const step::StepReport&)>;
std::map<int, double> answers(step::Scene scenario, bool second_order,
                              const std::vector<int>& steps, const Answer& answer)
{
  scenario.time.second_order = second_order;
  std::vector<double> lengths;
  for (int step : steps) lengths.push_back(step * unit);
  const test::Run run = test::run(scenario, lengths);
  std::map<int, double> found;
  int at = 0;
  for (std::size_t n = 0; n < steps.size(); ++n) found[at += steps[n]] = answer(run.reports[n + 1]);
  return found;
}

/// The worst error of any step over the largest value. Of BDF2 without the first step, which is
/// backward Euler's.
double worst(const std::map<int, double>& found, const std::map<int, double>& exact,
             bool without_first)
{
  double error = 0.0, size = 0.0;
  for (const auto& [at, value] : exact) size = std::max(size, std::abs(value));
  for (auto one = found.begin(); one != found.end(); ++one)
    if (!without_first || one != found.begin())
      error = std::max(error, std::abs(one->second - exact.at(one->first)));
  return error / size;
}

void expect_orders(const char* name, const step::Scene& scenario, const Answer& answer,
                   const std::map<int, double>& exact, int finest_steps)
{
  for (bool second_order : {false, true})
    for (const Pattern kind : {Pattern::alternating, Pattern::random, Pattern::halved_once}) {
      std::vector<double> error;
      for (int least : {4 * finest_steps, 2 * finest_steps, finest_steps})
        error.push_back(worst(answers(scenario, second_order, pattern(kind, least), answer), exact,
                              second_order));
      const double order = std::log2(error[1] / error[2]);
      std::printf("[ time ] %s, %s, pattern %d: errors %.2e %.2e %.2e, order %.2f\n", name,
                  second_order ? "bdf2" : "backward Euler", static_cast<int>(kind), error[0],
                  error[1], error[2], order);
      EXPECT_GE(order, second_order ? 1.8 : 0.9) << name;
    }
}

std::map<int, double> by_small_steps(const step::Scene& scenario, const Answer& answer)
{
  return answers(scenario, true, std::vector<int>(finest, 1), answer);
}

// A stiff block whose face is moved: the force is mass times acceleration, from the first step on.
TEST(VariableSteps, MassThatIsDriven)
{
  constexpr double omega = 40.0, amplitude = 0.01;
  step::Scene scenario = test::needle_scenario({4, 2, 2, Vec3(0.04, 0.02, 0.02)});
  scenario.needles.clear();
  scenario.tissue.materials = {{1e12, 0.3, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed.clear();
  scenario.tissue.boundary.displacements = {
      {"x0", Vec3(amplitude, 0, 0), curve([](double t) { return 1.0 - std::cos(omega * t); })}};
  std::map<int, double> exact;
  const double mass = 0.016;
  for (int k = 0; k <= finest; ++k)
    exact[k] = mass * amplitude * omega * omega * std::cos(omega * k * unit);
  const Answer force = [](const step::StepReport& report) { return report.holders.tools[0].x(); };
  // Steps stay far above the time that waves take: the block starts unstrained.
  expect_orders("driven mass", scenario, force, exact, 4);
  // Halves of halves: BDF2 is of order 1 in some of these steps, and never wild.
  for (bool second_order : {false, true})
    for (const Pattern kind : {Pattern::quarters, Pattern::eighths}) {
      std::vector<double> error;
      for (int least : {4, 2})
        error.push_back(
            worst(answers(scenario, second_order, pattern(kind, least), force), exact, true));
      std::printf("[ time ] halves of halves, %s: errors %.2e %.2e\n",
                  second_order ? "bdf2" : "backward Euler", error[0], error[1]);
      EXPECT_GE(std::log2(error[0] / error[1]), 0.85);
      EXPECT_LT(error[1], 0.15);
    }
  // With backward Euler the first step is not a worse one.
  const auto found = answers(scenario, false, {8, 8}, force);
  EXPECT_NEAR(found.at(8), exact.at(8), 0.03 * exact.at(0));
}

// A fluid whose volume is driven: pressures of incompressible motion.
TEST(VariableSteps, FluidThatIsDriven)
{
  step::Scene scenario = test::cavity_scenario(3, 1, cavity::Model::linear);
  scenario.time.is_static = false;
  scenario.tissue.materials[0].rayleigh_stiffness = 0.002;
  scenario.cavities.cavities[0].volume_curve =
      curve([](double t) { return 1.0 + 0.2 * smooth(t); });
  const Answer pressure = [](const step::StepReport& report) {
    return report.cavities[0].pressure;
  };
  expect_orders("driven fluid", scenario, pressure, by_small_steps(scenario, pressure), 2);
}

// A needle that sticks everywhere and is moved.
TEST(VariableSteps, NeedleThatSticks)
{
  step::Scene scenario = test::needle_scenario({4, 3, 3, Vec3(0.06, 0.04, 0.04), 0.1});
  scenario.tissue.materials[0].rayleigh_stiffness = 0.002;
  scenario.insertion.friction = test::same({1e6, 1e6, 0.0});
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.motion.inserted = 0.03;
  const Vec3 start = needle.motion.start().x;
  core::Csv trajectory;
  for (int k = 0; k <= finest; ++k) {
    const double s = 0.001 * smooth(k * unit);
    trajectory.rows.push_back({k * unit, start.x() + s, start.y() + 0.5 * s, start.z()});
  }
  needle.motion.trajectory = trajectory;
  const Answer force = [](const step::StepReport& report) {
    return report.needles[0].base.force.x();
  };
  expect_orders("stuck needle", scenario, force, by_small_steps(scenario, force), 2);
}

}  // namespace
}  // namespace trocar
