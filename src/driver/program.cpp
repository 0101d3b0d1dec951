#include "driver/program.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <thread>

#include "base/petsc.hpp"
#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "driver/log.hpp"
#include "driver/option_list.hpp"
#include "driver/petsc_options.hpp"
#include "driver/provenance.hpp"
#include "driver/recorder.hpp"
#include "driver/reports.hpp"
#include "driver/signals.hpp"
#include "io/size_field.hpp"

namespace trocar::driver {
namespace {

/// Hands what a run tells to results and log.
class RunObserver final : public step::Observer
{
 public:
  /// Fields are written every so many steps, and with the last one.
  RunObserver(Recorder& recorder, Log& log, long every, long steps)
      : recorder_(recorder), log_(log), every_(every), steps_(steps)
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

 private:
  Recorder& recorder_;
  Log& log_;
  long every_, steps_;
};

/// Every step or point of a scenario; gives the last state. Collective.
step::State run_to_end(step::Model& model, const Scenario& scenario, Recorder& recorder, Log& log)
{
  const bool swept = scenario.pv.has_value();
  RunObserver observer(recorder, log, swept ? 1 : scenario.output.every,
                       step::step_count(scenario.time));
  step::TimeStepper stepper(model, observer);
  step::State start = stepper.start();
  if (!swept) return stepper.run(std::move(start));
  post::PvSweep sweep = post::sweep_volume(model, *scenario.pv, start, observer);
  report_pv_curve(sweep.curve, recorder, log);
  return std::move(sweep.end);
}

void run_scene(int argc, char** argv, const base::Comm& comm)
{
  const Invocation invocation = read_invocation(argc, argv, comm);
  const base::PetscSession petsc(invocation.petsc);
  core::Options options(option_table(), invocation.given);
  const Scenario scenario = read_scenario(options, comm);
  const core::Stopwatch watch;
  step::Model model(scenario, comm);
  model.tissue.analyse();
  Log log(model, scenario);
  if (!invocation.outdated.empty())
    log.note("-edges and -edge_* are -conduits and -conduit_* now; the old names, here -" +
             invocation.outdated.front() + ", go with the next version");
  log.plan();
  step::prepare(model);
  refuse_unused(model.tissue.factor().solver().describe());
  log.set_up(watch.seconds());
  if (scenario.check_only) {
    log.note("check passed: nothing was run");
    return;
  }
  if (!scenario.output.size_field.empty())
    base::on_root(comm, [&] { io::require_size_field(scenario.output.size_field); });
  Recorder recorder(model, scenario, invocation, options.resolved());
  if (scenario.output.locking_gauge) report_locking(model, recorder, log);
  const step::State end = run_to_end(model, scenario, recorder, log);
  if (scenario.output.error_estimate) report_error(model, scenario.output, end, recorder, log);
  recorder.close();
  log.finish();
}

/// True when every rank comes here within two seconds: then the failure was agreed and all may
/// leave in order. Else somebody waits in a collective call that will never complete.
bool all_ranks_failed(MPI_Comm comm)
{
  MPI_Request request = MPI_REQUEST_NULL;
  if (MPI_Ibarrier(comm, &request) != MPI_SUCCESS) return false;
  for (int tick = 0; tick < 200; ++tick) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

int fail(const base::Comm& comm, MPI_Comm alarm, int code, const char* line)
{
  handle_signals(false);  // a launcher that ends the others need not be told of
  const bool agreed = all_ranks_failed(alarm);
  if (!agreed || comm.root()) std::fprintf(stderr, "trocar: error: %s\n", line);
  if (!agreed) MPI_Abort(comm.get(), code);
  return code;
}

}  // namespace

bool answer_questions(int argc, char** argv)
{
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "-help" || word == "--help" || word == "-h")
      print_help(std::cout);
    else if (word == "-help_markdown")
      print_markdown(std::cout);
    else if (word == "-version" || word == "--version")
      std::cout << build_description() << "\n";
    else
      continue;
    return true;
  }
  return false;
}

int run_program(int argc, char** argv, MPI_Comm world)
{
  MPI_Comm own = MPI_COMM_NULL, alarm = MPI_COMM_NULL;
  MPI_Comm_dup(world, &own);
  MPI_Comm_dup(world, &alarm);
  const base::Comm comm(own);
  handle_signals(comm.root());
  try {
    run_scene(argc, argv, comm);
    return 0;
  } catch (const core::Failure& failure) {
    return fail(comm, alarm, static_cast<int>(failure.code()), failure.what());
  } catch (const std::bad_alloc&) {
    return fail(comm, alarm, static_cast<int>(core::ExitCode::solver),
                "the memory does not suffice");
  } catch (const std::exception& error) {
    return fail(comm, alarm, static_cast<int>(core::ExitCode::internal), error.what());
  }
}

}  // namespace trocar::driver
