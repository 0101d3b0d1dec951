#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "driver/error_estimate.hpp"
#include "driver/locking_gauge.hpp"
#include "driver/pv_curve.hpp"
#include "support/cavity.hpp"
#include "support/hdf5.hpp"

// What a run says at its end, against what its parts say.
namespace trocar {
namespace {

using core::Vec3;

double sum_of_squares(const std::vector<double>& a)
{
  double sum = 0.0;
  for (double value : a) sum += value * value;
  return sum;
}

// The estimated error over the energy norm of what is estimated: twice the energy, which is the
// work of the plate's force on its way (Clapeyron), and the square of the error.
TEST(ErrorReport, IsAPartOfTheEnergyNorm)
{
  driver::Scenario scenario = test::needle_scenario({3, 2, 2, Vec3(0.06, 0.03, 0.03), 0.2});
  scenario.needles.clear();
  scenario.time.analysis = driver::Analysis::equilibrium;
  scenario.tissue.boundary.fixed = {{"x0", 7}};
  scenario.tissue.boundary.displacements = {{"x1", Vec3(0.002, 0.001, 0.0), std::nullopt}};
  scenario.output.folder = "error_report";
  scenario.output.quiet = true;
  driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const driver::StepResult start = simulation.initial_state();
  ASSERT_TRUE(start.state) << start.why;
  driver::Recorder recorder(simulation, {}, {});
  const driver::Log log(simulation);
  driver::report_error(simulation, recorder, log, *start.state);
  recorder.close(simulation);
  const double work = start.report.holders.tools[0].dot(Vec3(0.002, 0.001, 0.0));
  base::on_root(simulation.space().comm(), [&] {
    const test::H5Reader run("error_report/run.h5");
    const double square = sum_of_squares(run.dataset("/error_estimate/tet").values);
    EXPECT_GT(square, 1e-3 * work);
    EXPECT_NEAR(run.dataset("/error_estimate/relative").values[0],
                std::sqrt(square / (work + square)), 1e-9);
  });
}

// The straight line through a P-V curve and how well it does: slope and R² by their definitions.
TEST(PvCurve, HasTheLineOfLeastSquares)
{
  driver::Scenario scenario = test::cavity_scenario(3, 1, cavity::Model::follower);
  scenario.time.analysis = driver::Analysis::pv_curve;
  scenario.pv.low = 0.8;
  scenario.pv.high = 1.4;
  scenario.pv.points = 7;
  scenario.output.folder = "pv_report";
  scenario.output.displacement = false;
  scenario.output.quiet = true;
  driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const driver::StepResult start = simulation.initial_state();
  ASSERT_TRUE(start.state) << start.why;
  driver::Recorder recorder(simulation, {}, {});
  driver::Log log(simulation);
  driver::run_pv_curve(simulation, recorder, log, *start.state);
  recorder.close(simulation);
  base::on_root(simulation.space().comm(), [&] {
    const test::H5Reader run("pv_report/run.h5");
    const std::vector<double> x = run.dataset("/pv_curve/volume_ratio").values;
    const std::vector<double> p = run.dataset("/pv_curve/pressure").values;
    const auto n = static_cast<double>(x.size());
    ASSERT_EQ(x.size(), 7U);
    double sx = 0.0, sp = 0.0, sxx = 0.0, sxp = 0.0, spp = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sx += x[i];
      sp += p[i];
      sxx += x[i] * x[i];
      sxp += x[i] * p[i];
      spp += p[i] * p[i];
    }
    const double xx = sxx - sx * sx / n, xp = sxp - sx * sp / n, pp = spp - sp * sp / n;
    const double R2 = xp * xp / (xx * pp);
    EXPECT_LT(R2, 0.9999);  // it is a curve
    EXPECT_NEAR(run.dataset("/pv_curve/slope").values[0], xp / xx, 1e-9 * xp / xx);
    EXPECT_NEAR(run.dataset("/pv_curve/r_squared").values[0], R2, 1e-9);
  });
}

// Linear tets of tissue that hardly changes its volume lock: their cavity is stiffer than that of
// quadratic tets that do not, and the gauge says so.
TEST(LockingGauge, IsHowMuchTooStiffACavityIs)
{
  driver::Scenario scenario = test::cavity_scenario(3, 1, cavity::Model::linear);
  scenario.tissue.materials[0].poisson = 0.49;
  scenario.output.folder = "gauge_report";
  scenario.output.quiet = true;
  driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  simulation.prepare();
  driver::Recorder recorder(simulation, {}, {});
  driver::report_locking(simulation, recorder, driver::Log(simulation));
  recorder.close(simulation);
  base::on_root(simulation.space().comm(), [&] {
    const test::H5Reader run("gauge_report/run.h5");
    EXPECT_GT(run.dataset("/locking_gauge/ratio").values.at(0), 1.5);
  });
}

// A needle in the air, rolled faster and faster: its holder's moment does the work that sets it
// going. With n equal gains of speed, by the ends of the steps, (n + 1)/n of the energy of motion
// and twice the first gain, which comes about within half a step.
TEST(Energy, TurningANeedleTakesItsEnergyOfMotion)
{
  driver::Scenario scenario = test::needle_scenario(test::plain);
  scenario.output.energy = true;
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.motion.entry.x() = -0.01;
  needle.density = 7850.0;
  needle.section.outer = 0.002;
  const int n = 20;
  scenario.time.step = 0.01;
  scenario.time.end = 0.01 * n;
  core::Csv rolls{"roll.csv", {"time", "x", "y", "z", "dx", "dy", "dz", "roll"}, {}};
  const Vec3 base = needle.motion.entry - Vec3(needle.motion.length, 0.0, 0.0);
  for (int k = 0; k <= n; ++k)
    rolls.rows.push_back(
        {0.01 * k, base.x(), base.y(), base.z(), 1.0, 0.0, 0.0, 0.005 * k * (k + 1)});
  needle.motion.trajectory = rolls;
  const driver::EnergyAccount e = test::run(scenario).states.back().energy;
  const double pi = std::numbers::pi, r = 0.002;
  const double inertia = 0.5 * 7850.0 * pi * r * r * needle.motion.length * r * r;
  const double rate = n * 0.01 / 0.01;
  EXPECT_NEAR(e.kinetic, 0.5 * inertia * rate * rate, 1e-9 * inertia * rate * rate);
  EXPECT_NEAR(e.supplied / e.kinetic, (n * (n + 1.0) + 2.0) / (n * n), 1e-6);
}

}  // namespace
}  // namespace trocar
