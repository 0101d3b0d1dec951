#pragma once

namespace trocar::core {

/// One implicit step, or one static equilibrium.
struct TimeStep
{
  double t = 0.0;  ///< end of the step [s]
  double h = 0.0;  ///< length [s]
  bool is_static = false;
  double load = 1.0;  ///< share of gravity, traction and prescribed displacement (load steps)
  double lead = 1.0;  ///< of u in h u' = lead (u - û): 1 backward Euler, 3/2 BDF2 (û: the past)

  double inverse() const { return is_static ? 0.0 : lead / h; }  ///< [1/s], 0 without inertia
};

}  // namespace trocar::core
