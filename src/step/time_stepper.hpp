#pragma once

#include <string>

#include "step/step.hpp"

namespace trocar::step {

/// Request to a run between two steps. The largest request of all ranks is served.
enum class Wish { nothing = 0, checkpoint = 1, end = 2 };

/// Progress of a run at an accepted step.
struct Progress
{
  int accepted = 0;           ///< steps so far; every part of a halved step counts; 0: the start
  long nominal = 0;           ///< completed steps of full length
  bool whole = true;          ///< a step of full length has just ended; false: only a part of one
  double seconds = 0.0;       ///< wall time of this step, the longest of all ranks [s]
  Wish wish = Wish::nothing;  ///< the largest request of all ranks
};

/// Receives the steps of a run. Every function is called on every rank.
class Observer
{
 public:
  virtual ~Observer() = default;
  virtual void accepted(const State& state, const StepReport& report, const Progress& at) = 0;
  virtual void rejected(double t, const std::string& why) = 0;
  /// Request of this rank. The largest of all ranks is found together with the step's wall time.
  virtual Wish wish() const { return Wish::nothing; }
  /// Called after every step of full length. False ends the run there.
  virtual bool goes_on(const State& /*state*/, const Progress& /*at*/) { return true; }
};

/// Takes a model through time in equal steps. A rejected step is retried as two halves, and so is
/// each half. A step is halved at most 8 times.
class TimeStepper
{
 public:
  /// Borrows both arguments.
  TimeStepper(Model& model, Observer& observer) : model_(&model), observer_(&observer) {}

  /// Makes the state before the first step. Throws Failure (70) when no equilibrium is found.
  /// Collective.
  State start();
  /// Runs from `state` to the end of the scene, or until the observer ends the run. `from`:
  /// progress at `state`, for runs that resume an earlier one. Throws Failure (70) when a step is
  /// rejected even after 8 halvings. Collective.
  State run(State state, const Progress& from = {});
  /// Takes one step of full length. Throws Failure (70) as `run` does. Collective.
  State advance(const State& old, const core::TimeStep& now);

 private:
  State advance_in_parts(const State& old, const core::TimeStep& now, int halvings, bool ends);

  Model* model_;
  Observer* observer_;
  Progress at_;
};

}  // namespace trocar::step
