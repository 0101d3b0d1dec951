#pragma once

#include <optional>
#include <string>

#include "core/stopwatch.hpp"
#include "driver/scenario.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// Progress on rank 0's standard output: one line per step, silent with -quiet.
class Log
{
 public:
  /// Borrows both.
  Log(const step::Model& model, const Scenario& scenario);

  /// What the factor will take, before it does. Collective.
  void plan() const;
  void set_up(double seconds) const;  ///< collective (solver description)
  void step(int number, const step::State& state, const step::StepReport& report);
  void note(const std::string& line) const;
  /// The run begins with the state of a checkpoint.
  void goes_on(const step::State& state);
  /// `stopped`: the time of the checkpoint that the run ended with before its end [s].
  void finish(std::optional<double> stopped) const;

 private:
  void cavities(const cavity::Cavities& cavities) const;
  void warn(const step::State& state, const step::StepReport& report);
  void warn_of_supports(const step::State& state);
  bool speaks() const;

  const step::Model* model_;
  const Scenario* scenario_;
  core::Stopwatch watch_;
  double begun_ = 0.0;  ///< where this run began, at 0 or a checkpoint [s]
  int lines_ = 0;
  step::EnergyAccount energy_;             ///< of the last step
  double friction_ = 0.0, cutting_ = 0.0;  ///< dissipated so far [J]
  double turned_over_ = 0.0;               ///< energy supplied so far, there and back [J]
  bool folded_ = false, gained_ = false;   ///< in the last step: an event is told once
  std::vector<bool> widened_;              ///< by needle: told that its support is wider than asked
};

}  // namespace trocar::driver
