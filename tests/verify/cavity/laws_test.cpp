#include <gtest/gtest.h>

#include <cmath>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using test::press;
using test::solved;

// Every law: what the wall holds is what the fluid takes at its pressure.
TEST(Laws, VolumeOfTheWallIsThatOfTheFluid)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower})
    for (auto kind :
         {law::FluidLaw::Kind::bulk, law::FluidLaw::Kind::gas, law::FluidLaw::Kind::table}) {
      step::Scene scenario = test::cavity_scenario(5, 3, model, Solver::exact);
      press(scenario, 0.004);
      cavity::CavitySettings& one = scenario.cavities.cavities[0];
      one.fluid.kind = kind;
      one.fluid.bulk_modulus = 3e4;
      one.fluid.ambient = 2e4;
      one.fluid.table =
          law::MonotoneSpline({-1e3, 0, 500, 1e3, 4e3}, {3e-5, 2.7e-5, 2.69e-5, 2.6e-5, 2e-5});
      step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
      const step::Outcome<step::Accepted> result = solved(simulation);
      const cavity::CavityReport& report = result->report.cavities[0];
      const double V0 = simulation.cavities->wall(0).volume();
      const double fluid = one.fluid.at(report.pressure, V0, 0.0).volume;
      EXPECT_GT(report.pressure, 100.0);
      EXPECT_LT(fluid, V0);
      if (model == Model::linear)
        EXPECT_NEAR(report.volume, fluid, 0.02 * V0);
      else
        EXPECT_NEAR(report.volume, fluid, 2e-12 * V0);
    }
}

// A given pressure opens the cavity as far as volume control says, in every tissue, at the start of
// a static or a dynamic run; a fluid enclosed at that pressure then stays as it is.
TEST(GivenPressure, IsTheInverseOfVolumeControl)
{
  for (tissue::Model tissue : {tissue::Model::linear, tissue::Model::corotational})
    for (double part : {0.9, 1.001, 1.1}) {
      step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
      scenario.tissue.model = tissue;
      scenario.tissue.lag_tolerance = 1e-8;
      step::Scene volume = scenario, pressure = scenario, enclosed = scenario;
      volume.cavities.cavities[0].volume = part * 2.7e-5;
      const cavity::CavityReport held = solved(volume).cavities[0];
      pressure.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::pressure;
      pressure.cavities.cavities[0].pressure.mean = held.pressure;
      EXPECT_NEAR(solved(pressure).cavities[0].volume, part * 2.7e-5, 1e-7 * 2.7e-5);
      enclosed.cavities.cavities[0].initial_pressure = held.pressure;
      enclosed.time.is_static = false;
      enclosed.time.start_in_equilibrium = true;
      enclosed.time.step = 0.02;
      enclosed.time.end = 0.1;
      const test::Run run = test::run(enclosed);
      EXPECT_NEAR(run.reports.front().cavities[0].volume, part * 2.7e-5, 1e-7 * 2.7e-5);
      EXPECT_NEAR(run.reports.back().cavities[0].pressure, held.pressure,
                  1e-5 * std::abs(held.pressure));
    }
}

}  // namespace
}  // namespace trocar
