#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/history.hpp"
#include "driver/option_source.hpp"
#include "io/results.hpp"
#include "step/time_stepper.hpp"

namespace trocar::driver {

/// Names what a run leaves behind and hands it to `io`, which knows fields but no physics.
class Recorder
{
 public:
  /// Borrows model and scenario. Makes the result folder on rank 0, or goes on in that of the
  /// checkpoint `from` where the scenario does; Failure (74, 65) on every rank. Collective.
  Recorder(const step::Model& model, const Scenario& scenario, const Invocation& invocation,
           const std::vector<core::ResolvedOption>& options, const io::Checkpoint* from = nullptr);

  /// One history row, and a field file when `with_fields`. `step` counts accepted steps.
  /// Collective.
  void record(const step::State& state, const step::StepReport& report, int step, double seconds,
              bool with_fields);

  /// A dataset of its own in run.h5. Collective.
  void table(const std::string& path, const std::vector<double>& values, const std::string& units);
  /// A checkpoint of a step that has just been recorded. Collective.
  void checkpoint(const step::State& state, const step::Progress& at);
  void close();  ///< collective

 private:
  const step::Model* model_;
  const OutputSettings* output_;
  std::vector<io::Checkpoint::Option> options_;  ///< on rank 0 only
  std::vector<History> histories_;
  std::optional<io::Results> results_;  ///< on rank 0 only
};

}  // namespace trocar::driver
