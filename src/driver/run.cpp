#include "driver/run.hpp"

#include <cstdio>
#include <optional>
#include <utility>

#include "base/petsc.hpp"
#include "core/words.hpp"
#include "driver/checkpoints.hpp"
#include "driver/log.hpp"
#include "driver/option_list.hpp"
#include "driver/petsc_options.hpp"
#include "driver/provenance.hpp"
#include "driver/reports.hpp"
#include "driver/restart.hpp"
#include "driver/signals.hpp"
#include "io/size_field.hpp"
#include "step/archive.hpp"

namespace trocar::driver {
namespace {

/// Passes the events of a run to results, log and checkpoints.
class RunObserver final : public step::Observer
{
 public:
  /// Borrows all arguments. Fields are written every -output_every steps and after the last step;
  /// in a P-V sweep at every point.
  RunObserver(const Scenario& scenario, Recorder& recorder, Log& log, Checkpoints& checkpoints)
      : recorder_(recorder),
        log_(log),
        checkpoints_(checkpoints),
        every_(scenario.pv ? 1 : scenario.output.every),
        steps_(step::step_count(scenario.time))
  {
  }

  void accepted(const step::State& state, const step::StepReport& report,
                const step::Progress& at) override
  {
    const bool fields = at.whole && (at.nominal == steps_ || at.nominal % every_ == 0);
    recorder_.record(state, report, at.accepted, at.seconds, fields);
    log_.step(at.accepted, state, report);
  }
  void rejected(double t, const std::string& why) override
  {
    log_.note("step to t = " + core::shown(t) + " s rejected: " + why);
  }
  step::Wish wish() const override { return checkpoints_.wish(); }
  bool goes_on(const step::State& state, const step::Progress& at) override
  {
    return checkpoints_.goes_on(state, at);
  }

 private:
  Recorder& recorder_;
  Log& log_;
  Checkpoints& checkpoints_;
  long every_, steps_;
};

/// State and progress of an earlier run at its checkpoint.
struct Reached
{
  step::State state;
  step::Progress at;
};

/// Restores state and progress from a checkpoint. The model forgets all else: its caches are
/// dropped, and its ledger becomes that of the checkpoint. Failure (65) when the checkpoint is of
/// another scene, (64) when a needle would jump. Collective.
Reached resume(step::Model& model, const Scenario& scenario, const io::Checkpoint& from)
{
  Reached place;
  try {
    place.state = step::restored(from.state, model.space);
    const step::State& state = place.state;
    const std::size_t needles = scenario.needles.size();
    const cavity::Settings& cavities = scenario.cavities;
    if (state.needles.size() != needles || state.insertions.size() != needles ||
        state.cavities.cavity.size() != cavities.cavities.size() ||
        state.cavities.conduit.size() != cavities.conduits.size())
      throw core::data_error("it has other needles, cavities or conduits");
  } catch (const core::Failure& failure) {
    throw core::data_error("the checkpoint in " + scenario.restart.folder +
                           " is not one of this scene: " + failure.what());
  }
  refuse_jumps(scenario.needles, place.state);
  place.at.accepted = static_cast<int>(from.time.accepted);
  place.at.nominal = static_cast<long>(from.time.nominal);
  model.drop_caches();
  model.ledger = {};
  for (const auto& [name, count] : from.ledger)
    for (const auto& [member, of_ledger] : core::Ledger::members())
      if (member == name) model.ledger.*of_ledger = count;
  return place;
}

/// Objects that a run needs. Borrows all.
struct RunParts
{
  step::Model& model;
  const Scenario& scenario;
  Recorder& recorder;
  Log& log;
  const core::Stopwatch& since_start;
};

/// Takes all steps, or sweeps all points of a P-V curve, and returns the last state. `place`: where
/// an earlier run stopped; empty: begin at the start. Collective.
step::State run_to_end(const RunParts& with, Checkpoints& checkpoints, std::optional<Reached> place)
{
  if (with.scenario.output.locking_gauge) report_locking(with.model, with.recorder, with.log);
  RunObserver observer(with.scenario, with.recorder, with.log, checkpoints);
  step::TimeStepper stepper(with.model, observer);
  if (place) return stepper.run(std::move(place->state), place->at);
  step::State start = stepper.start();
  if (!with.scenario.pv) return stepper.run(std::move(start));
  post::PvSweep sweep = post::sweep_volume(with.model, *with.scenario.pv, start, observer);
  report_pv_curve(sweep.curve, with.recorder, with.log);
  return std::move(sweep.end);
}

/// Runs to the end, writes the final reports and closes the results. Collective.
core::ExitCode run_and_report(const RunParts& with, std::optional<Reached> place)
{
  Checkpoints checkpoints(with.model, with.scenario, with.recorder, with.since_start);
  const OutputSettings& output = with.scenario.output;
  const step::State end = run_to_end(with, checkpoints, std::move(place));
  const std::optional<double> stopped = checkpoints.stopped();
  if (output.error_estimate && !stopped)
    report_error(with.model, output, end, with.recorder, with.log);
  with.recorder.close();
  with.log.finish(stopped);
  return stopped ? core::ExitCode::checkpoint : core::ExitCode::ok;
}

void begin_log(const Log& log, const Invocation& invocation, const Scenario& scenario,
               const io::Checkpoint* from)
{
  if (!invocation.outdated.empty())
    log.note("-edges and -edge_* are -conduits and -conduit_* now; the old names, here -" +
             invocation.outdated.front() + ", go with the next version");
  if (!from) return;
  log.note("goes on after step " + std::to_string(from->time.accepted) +
           ", t = " + core::shown(from->time.now) + " s, of " + scenario.restart.folder);
  if (from->version != build_description())  // known on rank 0, which is the one that speaks
    log.note("note: the checkpoint was written by " + from->version);
}

/// Result of a restart whose checkpoint is at the end already. For a branch this is a Failure (64),
/// because its folder would stay empty.
core::ExitCode nothing_left(const Scenario& scenario, const io::Checkpoint& from,
                            const base::Comm& comm)
{
  const std::string what = "the checkpoint of t = " + core::shown(from.time.now) + " s in " +
                           scenario.restart.folder + " is that of the end: no step is left";
  if (scenario.restart.branch) throw core::option_error("option -time_end: " + what);
  if (comm.root()) std::printf("note: %s\n", what.c_str());
  return core::ExitCode::ok;
}

}  // namespace

core::ExitCode run_scene(int argc, char** argv, const base::Comm& comm)
{
  const core::Stopwatch since_start;
  const Invocation invocation = read_invocation(argc, argv, comm);
  const base::PetscSession petsc(invocation.petsc);
  core::Options options(option_table(), invocation.given);
  Scenario scenario = read_scenario(options, comm);
  std::optional<io::Checkpoint> from;
  if (!scenario.restart.folder.empty()) {
    from = read_restart(scenario, options.resolved(), comm);
    if (!continue_time(from->time, scenario)) return nothing_left(scenario, *from, comm);
  }
  const core::Stopwatch watch;
  step::Model model(scenario, comm);
  model.tissue.analyse();
  Log log(model, scenario);
  begin_log(log, invocation, scenario, from ? &*from : nullptr);
  log.plan();
  step::prepare(model);
  refuse_unused(model.tissue.factor().solver().describe());
  log.set_up(watch.seconds());
  std::optional<Reached> place;
  if (from) place = resume(model, scenario, *from);
  if (scenario.check_only) {
    log.note("check passed: nothing was run");
    return core::ExitCode::ok;
  }
  if (!scenario.output.size_field.empty())
    base::on_root(comm, [&] { io::require_size_field(scenario.output.size_field); });
  Recorder recorder(model, scenario, invocation, options.resolved(), from ? &*from : nullptr);
  if (from && !scenario.restart.branch)
    checkpoint_stands_at(from->time.now, scenario.output.folder);
  if (place) log.goes_on(place->state);
  return run_and_report({model, scenario, recorder, log, since_start}, std::move(place));
}

}  // namespace trocar::driver
