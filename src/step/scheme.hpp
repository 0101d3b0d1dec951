#pragma once

#include "core/outcome.hpp"
#include "step/model.hpp"
#include "step/state.hpp"

namespace trocar::step {

/// Time scheme of one step: backward Euler or BDF2, for steps of different length. It gives
/// velocity and acceleration at the end of the step from the displacement there (docs/theory.md
/// section 1).
class Scheme
{
 public:
  /// Borrows the old state. `asked`: the step, still without `lead` and `interval`. `order`: with 1
  /// the step is one of backward Euler, whatever the past allows.
  Scheme(const Model& model, const State& old, const core::TimeStep& asked, int order = 2);
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  const core::TimeStep& now() const { return now_; }  ///< `asked` with the scheme's rates
  /// State whose u and v are the û and v̂ of h v = lead (u - û) and a = (v - v̂)/h̄.
  const State& past() const { return *past_; }
  bool second_order() const { return past_ == &extrapolated_; }
  /// Error terms of the velocity at the end of the step.
  const Differenced& velocity() const { return velocity_; }
  /// Error terms that this step assumes for the velocity of the old state.
  const Differenced& old_velocity() const { return old_velocity_; }

 private:
  void extrapolate(const State& old, double r);

  core::TimeStep now_;
  const State* past_;
  State extrapolated_;
  Differenced velocity_, old_velocity_;
};

}  // namespace trocar::step
