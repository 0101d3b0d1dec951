#include "driver/program.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <thread>

#include "base/heartbeat.hpp"
#include "core/failure.hpp"
#include "driver/option_list.hpp"
#include "driver/provenance.hpp"
#include "driver/run.hpp"
#include "driver/signals.hpp"

namespace trocar::driver {
namespace {

/// True when every rank comes here within two seconds. Then all ranks know of the failure and may
/// leave in order. Otherwise some rank waits in a collective call that will never complete.
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
  handle_signals(false);  // print nothing when the launcher ends this rank by a signal
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
  const base::Heartbeat heartbeat(own, most_silence, end_for_silence);
  try {
    return static_cast<int>(run_scene(argc, argv, comm));
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
