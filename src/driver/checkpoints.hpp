#pragma once

#include <optional>

#include "core/stopwatch.hpp"
#include "driver/recorder.hpp"
#include "io/checkpoint.hpp"

namespace trocar::driver {

/// Decides when checkpoints are due and writes them, only after steps of full length. Every
/// checkpoint drops the caches. So the next steps are the same, whether this run takes them or a
/// run that restarts from the checkpoint.
class Checkpoints
{
 public:
  /// Borrows model, scenario and recorder. `since_start`: stopwatch of the program, for -time_wall.
  Checkpoints(step::Model& model, const Scenario& scenario, Recorder& recorder,
              const core::Stopwatch& since_start);

  /// What this rank asks for after the present step: signals and its clock decide. Not collective.
  step::Wish wish() const;
  /// Writes a checkpoint when one is due after this step. False when the run ends here. Collective.
  bool goes_on(const step::State& state, const step::Progress& at);
  /// Time of the checkpoint that ended the run early [s]; empty: the run did not end early.
  std::optional<double> stopped() const { return stopped_; }

 private:
  step::Model* model_;
  const Scenario* scenario_;
  Recorder* recorder_;
  core::Stopwatch since_start_, since_last_;
  std::optional<double> stopped_;
};

}  // namespace trocar::driver
