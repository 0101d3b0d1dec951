#pragma once

#include <functional>
#include <vector>

#include "driver/scenario.hpp"
#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// Data of a step from which the histories take their values.
struct Moment
{
  const step::Model& model;
  const step::State& state;
  const step::StepReport& report;
  double build_seconds;  ///< wall time for compliance columns, slowest rank [s]
  double seconds;        ///< wall time of the step [s]
};

/// One history: its name, shape and unit, and the function that gives a row.
struct History
{
  io::Series series;
  std::function<std::vector<double>(const Moment&)> values;
};

/// All histories of a run, in the order in which `Results` stores them.
std::vector<History> histories(const Scenario& scenario);

}  // namespace trocar::driver
