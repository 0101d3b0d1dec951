#pragma once

namespace trocar::core {

/// One backward Euler step, or one static equilibrium.
struct TimeStep
{
  double t = 0.0;  ///< end of the step [s]
  double h = 0.0;  ///< length [s]
  bool is_static = false;
  double load = 1.0;  ///< share of gravity, traction and prescribed displacement (load steps)

  double inverse() const { return is_static ? 0.0 : 1.0 / h; }  ///< [1/s], 0 without inertia
};

}  // namespace trocar::core
