#pragma once

#include <compare>
#include <optional>

namespace trocar::core {

/// Factors [1/s] that give velocity and acceleration at the end of a step from the displacement u:
///   v = velocity (u - û),  a = acceleration (v - v̂).
/// The time scheme extrapolates û and v̂ from the past (theory 1). Both factors are 0 in statics.
/// The tissue operator depends on both factors.
struct Rates
{
  double velocity = 0.0, acceleration = 0.0;
  double mass = 0.0;  ///< s of a further term s M in the operator alone [1/s²]

  auto operator<=>(const Rates&) const = default;
};

/// One implicit step, or one static equilibrium.
struct TimeStep
{
  double t = 0.0;  ///< end of the step [s]
  double h = 0.0;  ///< length of the step [s]
  bool is_static = false;
  double load = 1.0;  ///< share of gravity, traction and prescribed displacement (load steps)
  double lead = 1.0;  ///< factor in h v = lead (u - û): 1 backward Euler, 3/2 BDF2 with equal steps
  std::optional<double> interval{};  ///< h̄ > 0 in a = (v - v̂)/h̄ [s]; none: h
  /// Rate s [1/s²] of s M in the static operator, where contact alone holds a body. Its force is
  /// iterated away, so that no result depends on it (docs/theory.md section 14).
  double proximal = 0.0;
  /// True for the state before the first step. It takes no time: nothing flows, slides or advances.
  bool start = false;

  /// The equilibrium before the first step, at t = 0. `h`: length of the steps to come [s].
  static TimeStep at_start(double h)
  {
    TimeStep now{0.0, h, true};
    now.start = true;
    return now;
  }

  double begin() const { return start ? t : t - h; }  ///< [s]

  Rates rates() const
  {
    if (is_static) return {};
    return {lead / h, 1.0 / interval.value_or(h)};
  }
  /// Those of the tissue operator.
  Rates operator_rates() const { return is_static ? Rates{0.0, 0.0, proximal} : rates(); }
};

}  // namespace trocar::core
