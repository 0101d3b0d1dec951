#pragma once

#include "core/outcome.hpp"
#include "step/model.hpp"
#include "step/state.hpp"

namespace trocar::step {

/// How a step's time derivatives follow from its end: backward Euler or BDF2, for steps of any
/// length.
class Scheme
{
 public:
  /// Borrows the old state.
  Scheme(const Model& model, const State& old, const core::TimeStep& asked);
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  const core::TimeStep& now() const { return now_; }  ///< with the rates of the scheme
  /// û and v̂ in h v = lead (u - û) and a = (v - v̂)/h̄.
  const State& past() const { return *past_; }
  /// What the new velocity stands for.
  const Differenced& velocity() const { return velocity_; }
  /// The old state's, as this step sees it.
  const Differenced& old_velocity() const { return old_velocity_; }

 private:
  void extrapolate(const State& old, double r);

  core::TimeStep now_;
  const State* past_;
  State extrapolated_;
  Differenced velocity_, old_velocity_;
};

}  // namespace trocar::step
