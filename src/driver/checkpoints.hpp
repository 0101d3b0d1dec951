#pragma once

#include <optional>

#include "core/stopwatch.hpp"
#include "driver/recorder.hpp"
#include "io/checkpoint.hpp"

namespace trocar::driver {

/// Makes checkpoints of a run, at the ends of steps of full length alone. A checkpoint is a
/// barrier: caches are dropped, so that what follows does not depend on whether the run went on or
/// another one did.
class Checkpoints
{
 public:
  /// Borrows all. `since_start`: of the program, which -time_wall counts from.
  Checkpoints(step::Model& model, const Scenario& scenario, Recorder& recorder,
              const core::Stopwatch& since_start);

  /// What this rank wants after the step, by its signals and clock.
  step::Wish wish() const;
  /// False when the run ends here. Collective.
  bool goes_on(const step::State& state, const step::Progress& at);
  /// The time at which it ended, if it did [s].
  std::optional<double> stopped() const { return stopped_; }

 private:
  step::Model* model_;
  const Scenario* scenario_;
  Recorder* recorder_;
  core::Stopwatch since_start_, since_last_;
  std::optional<double> stopped_;
};

}  // namespace trocar::driver
