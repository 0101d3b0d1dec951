#include "driver/time_options.hpp"

#include <cmath>
#include <sstream>

#include "core/words.hpp"

namespace trocar::driver {
namespace {

/// Length of equal steps up to T [s]: h when T/h is a whole number to 1e-6, else the longest length
/// below h that divides T.
double equal_steps(double h, double T)
{
  constexpr double whole = 1e-6;
  const double ratio = T / h, nearest = std::round(ratio);
  if (T == 0.0 || (nearest >= 1.0 && std::abs(ratio - nearest) <= whole)) return h;
  return T / std::ceil(ratio);
}

/// Reads -time_newton_max; returns 0 for auto.
int read_newton(core::Options& options)
{
  const std::string text = options.text("time_newton_max");
  if (text == "auto") return 0;
  std::istringstream words(text);
  int most = 0;
  constexpr int limit = 1'000'000;
  if (!(words >> most) || !words.eof() || most < 1 || most > limit)
    throw core::option_error("option -time_newton_max: '" + text +
                             "' is neither auto nor a whole number from 1 to 1000000");
  return most;
}

}  // namespace

/// Throws Failure (64) for a run that ends within its first step or takes more than 1e9 steps: both
/// are taken for typing errors.
static void check_steps(const step::TimeSettings& time)
{
  constexpr double most_steps = 1e9, within = 1.0 - 1e-6;
  if (time.end == 0.0) return;
  if (time.end < within * time.asked)
    throw core::option_error("option -time_end: the end, " + core::shown(time.end) +
                             " s, lies within the first step, -time_step " +
                             core::shown(time.asked));
  if (!(time.end / time.asked <= most_steps))
    throw core::option_error("option -time_step: " + core::shown(time.end / time.asked) +
                             " steps to the end, more than 1e9");
}

step::TimeSettings read_time(core::Options& options)
{
  step::TimeSettings time;
  const std::string analysis = options.text("analysis");
  time.is_static = analysis != "dynamic";
  time.asked = options.real("time_step");
  time.end = options.real("time_end");
  if (analysis != "pv_curve") check_steps(time);
  time.step = equal_steps(time.asked, time.end);
  time.start_in_equilibrium = options.text("time_initial") == "equilibrium";
  time.second_order = options.text("time_scheme") == "bdf2";
  time.newton_max = read_newton(options);
  time.direction_max = options.integer("constraint_direction_max");
  return time;
}

}  // namespace trocar::driver
