#include "support/scene.hpp"

#include <cmath>

namespace trocar::test {

step::Scene needle_scenario(const BlockShape& shape)
{
  step::Scene scenario;
  scenario.mesh = block(shape);
  scenario.time.step = 0.02;
  scenario.tissue.model = tissue::Model::linear;
  scenario.tissue.materials = {{5000.0, 0.4, 1000.0, 0.0, 0.02}};
  scenario.tissue.boundary.fixed = {{"z0", 7}};
  needle::NeedleSettings needle;
  needle.name = "needle";
  needle.model = needle::Model::rigid;
  needle.section = {0.0005, 0.0, 2e11, 0.3};
  needle.elements = 12;
  needle.motion.entry = core::Vec3(0, 0.0173, 0.0231);
  needle.motion.length = 0.08;
  needle.motion.velocity = 0.02;
  needle.motion.depth = 0.04;
  scenario.needles = {needle};
  scenario.insertion.friction = same({10.0, 10.0, 0.0});
  return scenario;
}

namespace {

/// Keeps everything; a rejected step is not what a test wants.
struct Keeper : step::Observer
{
  void accepted(const step::State& state, const step::StepReport& report,
                const step::Progress& /*at*/) override
  {
    run.states.push_back(state);
    run.reports.push_back(report);
  }
  void rejected(double t, const std::string& why) override
  {
    throw core::solver_error("rejected at t = " + std::to_string(t) + ": " + why);
  }
  Run run;
};

}  // namespace

Run run(const step::Scene& scenario)
{
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  Keeper keeper;
  step::TimeStepper stepper(simulation, keeper);
  stepper.run(stepper.start());
  keeper.run.ledger = simulation.ledger;
  return keeper.run;
}

Run run(const step::Scene& scenario, const std::vector<double>& lengths)
{
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  Keeper keeper;
  step::TimeStepper stepper(simulation, keeper);
  step::State state = stepper.start();
  double t = 0.0;
  for (double h : lengths) {
    t += h;
    state = stepper.advance(state, {t, h, scenario.time.is_static});
  }
  keeper.run.ledger = simulation.ledger;
  return keeper.run;
}

}  // namespace trocar::test
