#include <gtest/gtest.h>

#include <cmath>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using core::Vec3;
using test::press;
using test::solved;

/// dV/dp of a cavity at rest [m³/Pa].
double compliance(step::Scene scenario)
{
  cavity::CavitySettings& one = scenario.cavities.cavities[0];
  scenario.tissue.boundary.displacements.clear();
  scenario.time.end = 0.0;
  scenario.time.is_static = true;
  scenario.cavities.conduits.clear();
  for (cavity::CavitySettings& any : scenario.cavities.cavities) any.initial_pressure.reset();
  one.fluid.kind = law::FluidLaw::Kind::pressure;
  one.pressure.mean = 1e-3;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::StepReport report = solved(simulation)->report;
  return (report.cavities[0].volume - simulation.cavities->wall(0).volume()) / 1e-3;
}

// A leak: p falls as backward Euler has it, p_0/(1 + h/RC)^n, which is exp(-t/RC) to first order;
// what left the cavity is what came out of the leak.
TEST(Network, LeakDecays)
{
  std::vector<double> error;
  for (int steps : {20, 40}) {
    step::Scene scenario = test::cavity_scenario(5, 3, Model::linear);
    const double C = compliance(scenario);
    const double tau = 0.5;
    scenario.cavities.cavities[0].initial_pressure = 2000.0;
    cavity::ConduitSettings leak;
    leak.name = "leak";
    leak.from = 0;
    leak.resistance = tau / C;
    scenario.cavities.conduits = {leak};
    scenario.time.end = 1.0;
    scenario.time.step = 1.0 / steps;
    const test::Run run = test::run(scenario);
    const double h = scenario.time.step;
    for (int n = 0; n <= steps; ++n)
      EXPECT_NEAR(run.reports[static_cast<std::size_t>(n)].cavities[0].pressure,
                  2000.0 / std::pow(1.0 + h / tau, n), 1e-8 * 2000.0);
    error.push_back(run.reports.back().cavities[0].pressure / 2000.0 - std::exp(-1.0 / tau));
    // A linear cavity's volume is V_0 + C p.
    EXPECT_NEAR(run.states.back().cavities.conduit[0].moved,
                C * (2000.0 - run.reports.back().cavities[0].pressure), 1e-7 * C * 2000.0);
  }
  EXPECT_NEAR(error[0] / error[1], 2.0, 0.1);
}

/// Two equal cavities far from each other.
step::Scene two_cavities(Model model)
{
  step::Scene scenario = test::cavity_scenario(5, 1, model, Solver::exact);
  test::BlockShape shape{11, 5, 5, Vec3(0.11, 0.05, 0.05)};
  const auto in = [](const Vec3& x, double at) {
    return (x - Vec3(at, 0.025, 0.025)).cwiseAbs().maxCoeff() < 0.0051;
  };
  shape.hole = [&](const Vec3& x) { return in(x, 0.025) || in(x, 0.085); };
  scenario.mesh = test::block(shape);
  test::add_surface(scenario.mesh, "wall", [&](const Vec3& x) { return in(x, 0.025); });
  test::add_surface(scenario.mesh, "other", [&](const Vec3& x) { return in(x, 0.085); });
  cavity::CavitySettings other = scenario.cavities.cavities[0];
  other.name = "other";
  other.surface = "other";
  scenario.cavities.cavities.push_back(other);
  return scenario;
}

// Compressible fluids at unlike pressures: what a conduit moves is amount, so that Σ V ρ stays what
// it was, V the volume that the model takes; and both pressures meet.
TEST(Network, AmountOfGasIsKept)
{
  for (const auto kind : {law::FluidLaw::Kind::gas, law::FluidLaw::Kind::bulk})
    for (Model model : {Model::linear, Model::frozen, Model::follower}) {
      step::Scene scenario = two_cavities(model);
      for (cavity::CavitySettings& one : scenario.cavities.cavities) {
        one.fluid.kind = kind;
        one.fluid.ambient = one.fluid.bulk_modulus = 2e4;
        one.initial_pressure = 0.0;
      }
      scenario.cavities.cavities[0].initial_pressure = 3000.0;
      cavity::ConduitSettings tube;
      tube.name = "tube";
      tube.from = 0;
      tube.to = 1;
      tube.resistance = 4e9;
      scenario.cavities.conduits = {tube};
      scenario.time.step = 0.1;
      scenario.time.end = 4.0;
      const test::Run run = test::run(scenario);
      const auto amount = [&](std::size_t n) {
        double counted = 0.0, seen = 0.0;
        for (std::size_t i = 0; i < 2; ++i) {
          const law::FluidLaw& fluid = scenario.cavities.cavities[i].fluid;
          const cavity::CavityState& mine = run.states[n].cavities.cavity[i];
          counted += mine.amount * fluid.density(mine.reference);
          const cavity::CavityReport& report = run.reports[n].cavities[i];
          seen += report.volume * fluid.density(report.pressure);
        }
        if (model != Model::linear) {
          EXPECT_NEAR(seen, counted, 1e-12 * counted);
        }
        return counted;
      };
      for (std::size_t n = 1; n < run.states.size(); ++n)
        EXPECT_NEAR(amount(n), amount(0), 1e-13 * amount(0));
      const auto& last = run.reports.back().cavities;
      EXPECT_GT(run.states.back().cavities.conduit[0].moved, 5e-8);
      EXPECT_NEAR(last[0].pressure, last[1].pressure, 5.0);
    }
}

/// A gas far above the pressure around it, which goes into another cavity as fast as it can.
step::Scene bursting(double resistance)
{
  step::Scene scenario = two_cavities(Model::linear);
  scenario.tissue.materials[0].young = 7e7;
  for (cavity::CavitySettings& one : scenario.cavities.cavities) {
    one.fluid.kind = law::FluidLaw::Kind::gas;
    one.fluid.ambient = 2e3;
    one.initial_pressure = 0.0;
  }
  scenario.cavities.cavities[0].initial_pressure = 2e4;
  cavity::ConduitSettings tube;
  tube.name = "tube";
  tube.from = 0;
  tube.to = 1;
  tube.resistance = resistance;
  scenario.cavities.conduits = {tube};
  scenario.time.step = 0.1;
  scenario.time.end = 0.4;
  return scenario;
}

// On the way to their pressures a step may ask for more gas than there is: it is met in halves, and
// nothing is lost.
TEST(Network, AGasIsNotDrainedOnTheWayToItsPressure)
{
  for (double resistance : {4e7, 4e8, 4e9}) {
    const step::Scene scenario = bursting(resistance);
    const test::Run run = test::run(scenario);  // throws where a step is rejected
    const auto amount = [&](std::size_t n) {
      double sum = 0.0;
      for (const cavity::CavityState& mine : run.states[n].cavities.cavity)
        sum += mine.amount * scenario.cavities.cavities[0].fluid.density(mine.reference);
      return sum;
    };
    for (std::size_t n = 1; n < run.states.size(); ++n)
      EXPECT_NEAR(amount(n), amount(0), 1e-13 * amount(0));
    EXPECT_GT(run.states.back().cavities.conduit[0].moved, 0.0);
  }
}

// More gas asked for than there is, by a flow that is prescribed: refused with that reason.
TEST(Network, ADrainedGasIsCalledThat)
{
  step::Scene scenario = bursting(4e9);
  scenario.cavities.conduits[0].to = -1;
  scenario.cavities.conduits[0].flow = 1e-3;
  try {
    test::run(scenario);
    FAIL() << "it was drained";
  } catch (const core::Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("more fluid would flow out within the step"),
              std::string::npos)
        << failure.what();
  }
}

// Two equal cavities: their pressures meet with τ = RC/2. Exact volumes: what
// leaves one arrives in the other.
TEST(Network, TwoCavitiesMeet)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    step::Scene scenario = two_cavities(model);
    scenario.cavities.cavities[0].initial_pressure = 100.0;
    scenario.cavities.cavities[1].initial_pressure = -100.0;
    step::Scene alone = scenario;
    const double C = compliance(alone);
    cavity::ConduitSettings tube;
    tube.name = "tube";
    tube.from = 0;
    tube.to = 1;
    tube.resistance = 1.0 / C;
    scenario.cavities.conduits = {tube};
    scenario.time.end = 0.5;
    scenario.time.step = 0.05;
    const test::Run run = test::run(scenario);
    const auto& last = run.reports.back().cavities;
    const double fallen = std::pow(1.0 + 0.05 * 2.0, -10);
    EXPECT_NEAR((last[0].pressure - last[1].pressure) / 200.0, fallen, 0.02 * fallen);
    const auto& first = run.reports.front().cavities;
    const double moved = run.states.back().cavities.conduit[0].moved;
    if (model != Model::linear) {
      const double V0 = 1e-6;
      EXPECT_NEAR(first[0].volume - last[0].volume, moved, 3e-12 * V0);
      EXPECT_NEAR(last[1].volume - first[1].volume, moved, 3e-12 * V0);
    }
  }
}

// Injection: the volume grows by what is pumped in, whatever the pressure does.
TEST(Network, InjectionIsKept)
{
  for (Model model : {Model::frozen, Model::follower}) {
    step::Scene scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    cavity::ConduitSettings pump;
    pump.name = "pump";
    pump.to = 0;
    pump.flow = 2e-6;
    pump.flow_curve = core::parse_csv("time,factor\n0,0\n1,1\n2,0\n", "test");
    scenario.cavities.conduits = {pump};
    scenario.time.step = 0.25;
    scenario.time.end = 2.0;
    const test::Run run = test::run(scenario);
    // Sum of backward Euler: 0.25 s · (0.25 + 0.5 + 0.75 + 1 + 0.75 + 0.5 + 0.25) = 1 s.
    EXPECT_NEAR(run.states.back().cavities.conduit[0].moved, 2e-6, 1e-18);
    EXPECT_NEAR(run.reports.back().cavities[0].volume - run.reports.front().cavities[0].volume,
                2e-6, 1e-11 * 2.7e-5);
    EXPECT_GT(run.reports.back().cavities[0].pressure, 100.0);
  }
}

// A valve lets fluid out and none in; gas and valve are laws that the dense problem settles.
TEST(Network, ValveAndGas)
{
  step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
  scenario.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::gas;
  scenario.cavities.cavities[0].fluid.ambient = 1e4;
  cavity::ConduitSettings valve;
  valve.name = "valve";
  valve.from = 0;
  valve.resistance = 1e9;
  valve.valve = true;
  scenario.cavities.conduits = {valve};
  scenario.time.step = 0.1;
  scenario.time.end = 2.0;
  press(scenario, 0.004);
  scenario.tissue.boundary.displacements[0].curve =
      core::parse_csv("time,factor\n0,0\n1,1\n2,-0.5\n", "test");
  const test::Run run = test::run(scenario);
  double moved = 0.0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double now = run.states[n].cavities.conduit[0].moved;
    EXPECT_GE(now, moved);
    const double p = run.reports[n].cavities[0].pressure;
    EXPECT_NEAR(run.states[n].cavities.conduit[0].flow, std::max(p, 0.0) / 1e9,
                1e-9 * std::abs(p) / 1e9);
    moved = now;
  }
  EXPECT_GT(moved, 0.0);
  EXPECT_LT(run.reports.back().cavities[0].pressure, 0.0);
}

}  // namespace
}  // namespace trocar
