#include "driver/checkpoints.hpp"

#include "driver/signals.hpp"

namespace trocar::driver {

Checkpoints::Checkpoints(step::Model& model, const Scenario& scenario, Recorder& recorder,
                         const core::Stopwatch& since_start)
    : model_(&model), scenario_(&scenario), recorder_(&recorder), since_start_(since_start)
{
}

step::Wish Checkpoints::wish() const
{
  const CheckpointSettings& settings = scenario_->checkpoint;
  if (end_wished()) return step::Wish::end;
  if (settings.wall > 0.0 && since_start_.seconds() >= settings.wall) return step::Wish::end;
  const bool due = settings.seconds > 0.0 && since_last_.seconds() >= settings.seconds;
  return due ? step::Wish::checkpoint : step::Wish::nothing;
}

bool Checkpoints::goes_on(const step::State& state, const step::Progress& at)
{
  const int every = scenario_->checkpoint.every;
  const bool in_turn = every > 0 && at.nominal % every == 0;
  const bool ends = at.wish == step::Wish::end && at.nominal < step::step_count(scenario_->time);
  if (!in_turn && !ends && at.wish != step::Wish::checkpoint) return true;
  recorder_->checkpoint(state, at);
  checkpoint_stands_at(state.t, scenario_->output.folder);
  model_->drop_caches();
  since_last_ = {};
  if (ends) stopped_ = state.t;
  return !ends;
}

}  // namespace trocar::driver
