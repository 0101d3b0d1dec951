#pragma once

#include <compare>
#include <optional>

namespace trocar::core {

/// How velocity and acceleration follow from the displacement at the end of a step,
///   v = velocity (u - û),  a = acceleration (v - v̂)   [1/s],
/// with the past û, v̂ of the time scheme. Both are 0 where there is no inertia. An operator belongs
/// to one pair of them.
struct Rates
{
  double velocity = 0.0, acceleration = 0.0;

  auto operator<=>(const Rates&) const = default;
};

/// One implicit step, or one static equilibrium.
struct TimeStep
{
  double t = 0.0;  ///< end of the step [s]
  double h = 0.0;  ///< length [s]
  bool is_static = false;
  double load = 1.0;  ///< share of gravity, traction and prescribed displacement (load steps)
  double lead = 1.0;  ///< of u in h v = lead (u - û): 1 backward Euler, 3/2 BDF2 (û: the past)
  std::optional<double> interval{};  ///< h̄ > 0 in a = (v - v̂)/h̄ [s]; none: h
  /// The state before the first step: it takes no time, so that nothing flows, slides or advances.
  bool start = false;

  /// The equilibrium before the first step, at t = 0; `h`: of the steps to come [s].
  static TimeStep at_start(double h)
  {
    TimeStep now{0.0, h, true};
    now.start = true;
    return now;
  }

  Rates rates() const
  {
    if (is_static) return {};
    return {lead / h, 1.0 / interval.value_or(h)};
  }
};

}  // namespace trocar::core
