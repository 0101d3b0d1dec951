#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/history.hpp"
#include "driver/option_source.hpp"
#include "io/results.hpp"
#include "step/time_stepper.hpp"

namespace trocar::driver {

/// Turns states and reports of a run into named fields and histories, and passes them to `io`,
/// which knows fields but no physics.
class Recorder
{
 public:
  /// Borrows model and scenario. Makes the result folder on rank 0. With a checkpoint `from`, the
  /// recorder continues in the folder of the checkpoint instead, unless the run is a branch.
  /// Failure (74, 65) on every rank. Collective.
  Recorder(const step::Model& model, const Scenario& scenario, const Invocation& invocation,
           const std::vector<core::ResolvedOption>& options, const io::Checkpoint* from = nullptr);

  /// Writes one history row, and a field file when `with_fields`. `step`: number of accepted steps;
  /// `seconds`: wall time of the step [s]. Collective.
  void record(const step::State& state, const step::StepReport& report, int step, double seconds,
              bool with_fields);

  /// Writes one dataset into run.h5. Collective.
  void table(const std::string& path, const std::vector<double>& values, const std::string& units);
  /// Writes a checkpoint of the step that was recorded last. Collective.
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
