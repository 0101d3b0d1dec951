#include "driver/time_options.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include "core/words.hpp"

namespace trocar::driver {
namespace {

/// Of equal steps to the end: h itself when it goes into T whole, to a millionth of it, else the
/// longest that is not above it.
double equal_steps(double h, double T)
{
  constexpr double whole = 1e-6;
  const double ratio = T / h, nearest = std::round(ratio);
  if (T == 0.0 || (nearest >= 1.0 && std::abs(ratio - nearest) <= whole)) return h;
  return T / std::ceil(ratio);
}

/// 0 for auto.
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

/// A run without a step, or with more than anyone could want, is a slip of the pen.
static void check_steps(const TimeSettings& time)
{
  constexpr double most_steps = 1e9, within = 1.0 - 1e-6;
  if (time.analysis == Analysis::pv_curve || time.end == 0.0) return;
  if (time.end < within * time.asked)
    throw core::option_error("option -time_end: the end, " + core::shown(time.end) +
                             " s, lies within the first step, -time_step " +
                             core::shown(time.asked));
  if (!(time.end / time.asked <= most_steps))
    throw core::option_error("option -time_step: " + core::shown(time.end / time.asked) +
                             " steps to the end, more than 1e9");
}

TimeSettings read_time(core::Options& options)
{
  TimeSettings time;
  const std::map<std::string, Analysis> analyses{{"dynamic", Analysis::dynamic},
                                                 {"static", Analysis::equilibrium},
                                                 {"pv_curve", Analysis::pv_curve}};
  time.analysis = analyses.at(options.text("analysis"));
  time.asked = options.real("time_step");
  time.end = options.real("time_end");
  check_steps(time);
  time.step = equal_steps(time.asked, time.end);
  time.start_in_equilibrium = options.text("time_initial") == "equilibrium";
  time.second_order = options.text("time_scheme") == "bdf2";
  time.newton_max = read_newton(options);
  time.direction_max = options.integer("constraint_direction_max");
  return time;
}

long step_count(const TimeSettings& time)
{
  return std::lround(time.end / time.step);
}

}  // namespace trocar::driver
