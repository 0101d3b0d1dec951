#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/option_source.hpp"
#include "driver/simulation.hpp"
#include "io/results.hpp"

namespace trocar::driver {

/// Names what a run leaves behind and hands it to `io`, which knows fields but no physics.
class Recorder
{
 public:
  /// Makes the result folder on rank 0; Failure (74) on every rank. Collective.
  Recorder(const Simulation& simulation, const Invocation& invocation,
           const std::vector<core::ResolvedOption>& options);

  /// One history row, and a field file when `with_fields`. `step` counts accepted steps.
  /// Collective.
  void record(const Simulation& simulation, const State& state, const StepReport& report, int step,
              double seconds, bool with_fields);

  /// A dataset of its own in run.h5. Collective.
  void table(const Simulation& simulation, const std::string& path,
             const std::vector<double>& values, const std::string& units);
  void close(const Simulation& simulation);  ///< collective

 private:
  std::optional<io::Results> results_;  ///< on rank 0 only
};

}  // namespace trocar::driver
