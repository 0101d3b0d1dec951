#pragma once

#include <optional>
#include <string>

#include "core/stopwatch.hpp"
#include "driver/scenario.hpp"
#include "step/step.hpp"

namespace trocar::driver {

/// Prints progress on standard output of rank 0: one line per step; nothing with -quiet.
class Log
{
 public:
  /// Borrows model and scenario.
  Log(const step::Model& model, const Scenario& scenario);

  /// Prints how much memory the factor will need, before it is allocated. Collective.
  void plan() const;
  void set_up(double seconds) const;  ///< prints mesh, solver and warnings; collective
  void step(int number, const step::State& state, const step::StepReport& report);
  void note(const std::string& line) const;
  /// Call it when the run begins with the state of a checkpoint.
  void goes_on(const step::State& state);
  /// Prints the summary. `stopped`: time of the checkpoint that ended the run early [s].
  void finish(std::optional<double> stopped) const;

 private:
  void cavities(const cavity::Cavities& cavities) const;
  void warn(const step::State& state, const step::StepReport& report);
  void print_energy() const;
  void warn_of_supports(const step::State& state);
  bool speaks() const;

  const step::Model* model_;
  const Scenario* scenario_;
  core::Stopwatch watch_;
  double begun_ = 0.0;  ///< time at which this run began: 0 or the time of its checkpoint [s]
  int lines_ = 0;
  step::EnergyAccount energy_;             ///< after the last step
  double friction_ = 0.0, cutting_ = 0.0;  ///< dissipated so far [J]
  double turned_over_ = 0.0;               ///< sum of |energy supplied| over all steps [J]
  /// True when the last step had an inverted element or a gain of energy. A warning is printed only
  /// when a flag becomes true.
  bool folded_ = false, gained_ = false;
  std::vector<bool> widened_;  ///< by needle: the warning of a wider tip support was printed
};

}  // namespace trocar::driver
