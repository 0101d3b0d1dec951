#include "driver/checkpoints.hpp"

#include "core/words.hpp"
#include "driver/signals.hpp"

namespace trocar::driver {
namespace {

/// What a rank asks for; the largest of all ranks' counts.
enum Wish { nothing = 0, checkpoint = 1, end = 2 };

}  // namespace

Checkpoints::Checkpoints(step::Model& model, const Scenario& scenario, Recorder& recorder)
    : model_(&model), scenario_(&scenario), recorder_(&recorder)
{
}

int Checkpoints::asks() const
{
  const CheckpointSettings& settings = scenario_->checkpoint;
  if (checkpoint_wished()) return end;
  if (settings.wall > 0.0 && since_start_.seconds() >= settings.wall) return end;
  const bool due = settings.seconds > 0.0 && since_last_.seconds() >= settings.seconds;
  return due ? checkpoint : nothing;
}

bool Checkpoints::goes_on(const step::State& state, const step::Progress& at)
{
  const int every = scenario_->checkpoint.every;
  const bool in_turn = every > 0 && at.nominal % every == 0;
  const bool ends = at.asked == end && at.nominal < step::step_count(scenario_->time);
  if (!in_turn && !ends && at.asked != checkpoint) return true;
  recorder_->checkpoint(state, at);
  tell_of_checkpoint("a checkpoint of t = " + core::shown(state.t) + " s stands: -restart " +
                     scenario_->output.folder + " goes on from it");
  model_->drop_caches();
  since_last_ = {};
  if (ends) stopped_ = state.t;
  return !ends;
}

}  // namespace trocar::driver
