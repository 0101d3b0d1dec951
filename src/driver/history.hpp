#pragma once

#include <functional>
#include <vector>

#include "driver/scenario.hpp"
#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// What the histories of a step are taken from.
struct Moment
{
  const step::Model& model;
  const step::State& state;
  const step::StepReport& report;
  double build_seconds;  ///< of compliance columns, the longest of all ranks [s]
  double seconds;        ///< of the step [s]
};

/// One history: what it is called, and what stands in its row.
struct History
{
  io::Series series;
  std::function<std::vector<double>(const Moment&)> values;
};

/// All histories of a run, in the order in which run.h5 has them.
std::vector<History> histories(const Scenario& scenario);

}  // namespace trocar::driver
