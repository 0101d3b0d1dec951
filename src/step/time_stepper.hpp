#pragma once

#include <string>

#include "step/step.hpp"

namespace trocar::step {

/// What somebody outside wants of a run between two steps; the largest of all ranks' counts.
enum class Wish { nothing = 0, checkpoint = 1, end = 2 };

/// Where a run has come to with an accepted step.
struct Progress
{
  int accepted = 0;           ///< steps so far, parts of halved ones each for itself; 0: the start
  long nominal = 0;           ///< steps of full length that are done
  bool whole = true;          ///< one of these has just ended; false between the parts of one
  double seconds = 0.0;       ///< wall time of this step, the longest of all ranks
  Wish wish = Wish::nothing;  ///< the largest of all ranks'
};

/// Is told how a run goes. Everything is called on every rank.
class Observer
{
 public:
  virtual ~Observer() = default;
  virtual void accepted(const State& state, const StepReport& report, const Progress& at) = 0;
  virtual void rejected(double t, const std::string& why) = 0;
  /// What this rank wants. Agreed by the reduction of the step's time.
  virtual Wish wish() const { return Wish::nothing; }
  /// After every step of full length; false ends the run there.
  virtual bool goes_on(const State& /*state*/, const Progress& /*at*/) { return true; }
};

/// Takes a model through time: equal steps to the end, each in halves when it is rejected, at
/// most 8 times over.
class TimeStepper
{
 public:
  /// Borrows both.
  TimeStepper(Model& model, Observer& observer) : model_(&model), observer_(&observer) {}

  /// The state before the first step. Failure (70) when there is none. Collective.
  State start();
  /// From the start, or from where an earlier run had come to, to the end of the scene or where the
  /// observer ends it. Failure (70) when a step is rejected however short it is. Collective.
  State run(State state, const Progress& from = {});
  /// One step of full length. Failure (70) likewise. Collective.
  State advance(const State& old, const core::TimeStep& now);

 private:
  State advance_in_parts(const State& old, const core::TimeStep& now, int halvings, bool ends);

  Model* model_;
  Observer* observer_;
  Progress at_;
};

}  // namespace trocar::step
