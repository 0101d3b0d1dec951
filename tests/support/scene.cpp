#include "support/scene.hpp"

#include <cmath>

namespace trocar::test {

driver::Scenario needle_scenario(const BlockShape& shape)
{
  driver::Scenario scenario;
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

Run run(const driver::Scenario& scenario)
{
  const auto steps = static_cast<std::size_t>(driver::step_count(scenario.time));
  return run(scenario, std::vector<double>(steps, scenario.time.step));
}

Run run(const driver::Scenario& scenario, const std::vector<double>& lengths)
{
  const base::Comm comm(MPI_COMM_WORLD);
  driver::Simulation simulation(scenario, comm);
  Run run;
  driver::StepResult result = simulation.initial_state();
  const auto keep = [&] {
    if (!result.state) throw core::solver_error("rejected: " + result.why);
    run.states.push_back(*result.state);
    run.reports.push_back(result.report);
  };
  keep();
  const bool is_static = scenario.time.analysis == driver::Analysis::equilibrium;
  double t = 0.0;
  for (double h : lengths) {
    t += h;
    const core::TimeStep now{t, h, is_static};
    result = is_static ? simulation.equilibrium(run.states.back(), now)
                       : simulation.step(run.states.back(), now);
    keep();
  }
  run.ledger = simulation.ledger();
  return run;
}

}  // namespace trocar::test
