#include <gtest/gtest.h>

#include <cmath>

#include "driver/reports.hpp"
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

struct Listener : step::Observer
{
  void accepted(const step::State&, const step::StepReport&, const step::Progress&) override {}
  void rejected(double, const std::string&) override {}
};

// The estimated error over the energy norm of what is estimated: twice the energy, which is the
// work of the plate's force on its way (Clapeyron), and the square of the error.
TEST(ErrorReport, IsAPartOfTheEnergyNorm)
{
  driver::Scenario scenario{test::needle_scenario({3, 2, 2, Vec3(0.06, 0.03, 0.03), 0.2})};
  scenario.needles.clear();
  scenario.time.is_static = true;
  scenario.tissue.boundary.fixed = {{"x0", 7}};
  scenario.tissue.boundary.displacements = {{"x1", Vec3(0.002, 0.001, 0.0), std::nullopt}};
  scenario.output.folder = "error_report";
  scenario.output.quiet = true;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> start = step::initial_state(simulation);
  ASSERT_TRUE(start) << start.why();
  driver::Recorder recorder(simulation, scenario, {}, {});
  const driver::Log log(simulation, scenario);
  driver::report_error(simulation, scenario.output, start->state, recorder, log);
  recorder.close();
  const double work = start->report.holders.tools[0].dot(Vec3(0.002, 0.001, 0.0));
  base::on_root(simulation.space.comm(), [&] {
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
  driver::Scenario scenario{test::cavity_scenario(3, 1, cavity::Model::follower)};
  const post::PvSettings settings{0, 0.8, 1.4, 7, 4};
  scenario.output.folder = "pv_report";
  scenario.output.displacement = false;
  scenario.output.quiet = true;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> start = step::initial_state(simulation);
  ASSERT_TRUE(start) << start.why();
  driver::Recorder recorder(simulation, scenario, {}, {});
  driver::Log log(simulation, scenario);
  Listener nobody;
  driver::report_pv_curve(post::sweep_volume(simulation, settings, start->state, nobody).curve,
                          recorder, log);
  recorder.close();
  base::on_root(simulation.space.comm(), [&] {
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
  driver::Scenario scenario{test::cavity_scenario(3, 1, cavity::Model::linear)};
  scenario.tissue.materials[0].poisson = 0.49;
  scenario.output.folder = "gauge_report";
  scenario.output.quiet = true;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  step::prepare(simulation);
  driver::Recorder recorder(simulation, scenario, {}, {});
  driver::report_locking(simulation, recorder, driver::Log(simulation, scenario));
  recorder.close();
  base::on_root(simulation.space.comm(), [&] {
    const test::H5Reader run("gauge_report/run.h5");
    EXPECT_GT(run.dataset("/locking_gauge/ratio").values.at(0), 1.5);
  });
}

}  // namespace
}  // namespace trocar
