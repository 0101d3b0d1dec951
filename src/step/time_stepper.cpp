#include "step/time_stepper.hpp"

#include <cmath>

#include "core/stopwatch.hpp"
#include "core/words.hpp"

namespace trocar::step {
namespace {

constexpr int most_halvings = 8;

}  // namespace

long step_count(const TimeSettings& time)
{
  return std::lround(time.end / time.step);
}

State TimeStepper::start()
{
  Outcome<Accepted> result = initial_state(*model_);
  if (!result) throw core::solver_error("at the start: " + result.why());
  at_ = {};
  observer_->accepted(result->state, result->report, at_);
  return std::move(result->state);
}

State TimeStepper::run(State state, const Progress& from)
{
  at_ = from;
  const TimeSettings& time = model_->scene.time;
  const long steps = step_count(time);
  for (long n = from.nominal + 1; n <= steps; ++n) {
    const bool not_whole = time.step != time.asked;  // then steps * h may miss `end` by rounding
    const double t = n == steps && not_whole ? time.end : static_cast<double>(n) * time.step;
    state = advance(state, {t, time.step, time.is_static});
    if (!observer_->goes_on(state, at_)) break;
  }
  return state;
}

State TimeStepper::advance(const State& old, const core::TimeStep& now)
{
  return advance_in_parts(old, now, 0, true);
}

State TimeStepper::advance_in_parts(const State& old, const core::TimeStep& now, int halvings,
                                    bool ends)
{
  const core::Stopwatch watch;
  Outcome<Accepted> result =
      now.is_static ? equilibrium(*model_, old, now) : step::advance(*model_, old, now);
  if (result) {
    ++model_->ledger.steps;
    ++at_.accepted;
    at_.nominal += ends ? 1 : 0;
    at_.whole = ends;
    core::VecX largest(2);
    largest << watch.seconds(), static_cast<double>(observer_->wish());
    model_->space.comm().max(largest);
    at_.seconds = largest[0];
    at_.wish = static_cast<Wish>(largest[1]);
    observer_->accepted(result->state, result->report, at_);
    return std::move(result->state);
  }
  ++model_->ledger.rejected_steps;
  observer_->rejected(now.t, result.why());
  if (halvings == most_halvings)
    throw core::solver_error("at t = " + core::shown(old.t) + " s: " + result.why() +
                             " (the step was halved " + std::to_string(halvings) + " times)");
  core::TimeStep half = now;
  half.h = 0.5 * now.h;
  half.t = now.t - half.h;
  const State middle = advance_in_parts(old, half, halvings + 1, false);
  half.t = now.t;
  return advance_in_parts(middle, half, halvings + 1, ends);
}

}  // namespace trocar::step
