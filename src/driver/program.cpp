#include "driver/program.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <thread>

#include "base/petsc.hpp"
#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "driver/error_estimate.hpp"
#include "driver/locking_gauge.hpp"
#include "driver/log.hpp"
#include "driver/option_list.hpp"
#include "driver/petsc_options.hpp"
#include "driver/provenance.hpp"
#include "driver/pv_curve.hpp"
#include "driver/recorder.hpp"
#include "driver/signals.hpp"
#include "io/size_field.hpp"

namespace trocar::driver {
namespace {

constexpr int most_halvings = 8;

/// Takes `old` to the end of a step, in halves when it is rejected. Every accepted part is
/// recorded. Collective.
class Clock
{
 public:
  Clock(Simulation& simulation, Recorder& recorder, Log& log)
      : simulation_(simulation), recorder_(recorder), log_(log)
  {
  }

  State run(State state)
  {
    const TimeSettings& time = simulation_.scenario().time;
    const long steps = step_count(time);
    for (long n = 1; n <= steps; ++n) {
      const bool not_whole = time.step != time.asked;  // T/N times N may miss T by round-off
      const double t = n == steps && not_whole ? time.end : static_cast<double>(n) * time.step;
      const bool output =
          n == steps || n % static_cast<long>(simulation_.scenario().output.every) == 0;
      state = advance(std::move(state), {t, time.step, time.analysis == Analysis::equilibrium}, 0,
                      output);
    }
    return state;
  }

 private:
  State advance(State old, const core::TimeStep& now, int halvings, bool output)
  {
    const core::Stopwatch watch;
    StepResult result =
        now.is_static ? simulation_.equilibrium(old, now) : simulation_.step(old, now);
    if (result.state) {
      ++simulation_.ledger().steps;
      ++accepted_;
      const double seconds = simulation_.space().comm().max(watch.seconds());
      recorder_.record(simulation_, *result.state, result.report, accepted_, seconds, output);
      log_.step(accepted_, *result.state, result.report);
      return std::move(*result.state);
    }
    ++simulation_.ledger().rejected_steps;
    log_.note("step to t = " + core::shown(now.t) + " s rejected: " + result.why);
    if (halvings == most_halvings)
      throw core::solver_error("at t = " + core::shown(old.t) + " s: " + result.why +
                               " (the step was halved " + std::to_string(halvings) + " times)");
    core::TimeStep half = now;
    half.h = 0.5 * now.h;
    half.t = now.t - half.h;
    old = advance(std::move(old), half, halvings + 1, false);
    half.t = now.t;
    return advance(std::move(old), half, halvings + 1, output);
  }

  Simulation& simulation_;
  Recorder& recorder_;
  Log& log_;
  int accepted_ = 0;
};

void run_scene(int argc, char** argv, const base::Comm& comm)
{
  const Invocation invocation = read_invocation(argc, argv, comm);
  const base::PetscSession petsc(invocation.petsc);
  core::Options options(option_table(), invocation.given);
  const Scenario scenario = read_scenario(options, comm);
  const core::Stopwatch watch;
  Simulation simulation(scenario, comm);
  simulation.analyse();
  Log log(simulation);
  log.plan();
  simulation.prepare();
  refuse_unused(simulation.tissue().describe_solver());
  log.set_up(watch.seconds());
  if (scenario.check_only) {
    log.note("check passed: nothing was run");
    return;
  }
  if (!scenario.output.size_field.empty())
    base::on_root(comm, [&] { io::require_size_field(scenario.output.size_field); });
  Recorder recorder(simulation, invocation, options.resolved());
  if (scenario.output.locking_gauge) report_locking(simulation, recorder, log);
  StepResult start = simulation.initial_state();
  if (!start.state) throw core::solver_error("at the start: " + start.why);
  recorder.record(simulation, *start.state, start.report, 0, 0.0, true);
  log.step(0, *start.state, start.report);
  if (scenario.time.analysis == Analysis::pv_curve)
    start.state = run_pv_curve(simulation, recorder, log, *start.state);
  else
    start.state = Clock(simulation, recorder, log).run(std::move(*start.state));
  if (scenario.output.error_estimate) report_error(simulation, recorder, log, *start.state);
  recorder.close(simulation);
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
