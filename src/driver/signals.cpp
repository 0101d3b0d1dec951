#include "driver/signals.hpp"

#include <unistd.h>
#include <array>
#include <csignal>
#include <cstring>
#include <initializer_list>

#include "core/failure.hpp"

namespace trocar::driver {
namespace {

// What a signal handler may look at.
volatile std::sig_atomic_t this_rank_speaks = 0, checkpoint_stands = 0, wished = 0;
std::array<char, 1024> way_on{};

void say(const char* text)
{
  // A signal handler may do no more about a failing write than go on.
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

extern "C" void end_with(int signal)
{
  if (this_rank_speaks) {
    say("trocar: error: ended by signal ");
    say(signal == SIGHUP ? "1 (SIGHUP)" : signal == SIGINT ? "2 (SIGINT)" : "15 (SIGTERM)");
    say("; ");
    say(checkpoint_stands ? way_on.data() : "what was written until now is whole");
    say("\n");
  }
  ::_exit(checkpoint_stands ? static_cast<int>(core::ExitCode::checkpoint) : 128 + signal);
}

extern "C" void wish(int /*signal*/)
{
  wished = 1;
}

}  // namespace

void handle_signals(bool speaks)
{
  this_rank_speaks = speaks ? 1 : 0;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);                // a file that may grow no more fails the write: 74
  for (int signal : {SIGHUP, SIGINT, SIGTERM})  // what nohup has ignored stays so
    if (std::signal(signal, end_with) == SIG_IGN) std::signal(signal, SIG_IGN);
  struct sigaction action = {};
  action.sa_handler = wish;
  action.sa_flags = SA_RESTART;  // no call that waits notices
  ::sigaction(SIGUSR1, &action, nullptr);
}

void end_for_silence(int rank, bool speaks)
{
  if (speaks) {
    const std::string line =
        "trocar: error: rank " + std::to_string(rank) + " has not run for " +
        std::to_string(most_silence) + " s (was it stopped?), so nobody can go on; " +
        (checkpoint_stands ? way_on.data() : "what was written until now is whole") + "\n";
    say(line.c_str());
  }
  ::_exit(
      static_cast<int>(checkpoint_stands ? core::ExitCode::checkpoint : core::ExitCode::internal));
}

void tell_of_checkpoint(const std::string& how_to_go_on)
{
  checkpoint_stands = 0;  // no handler reads while this is written
  std::strncpy(way_on.data(), how_to_go_on.c_str(), way_on.size() - 1);
  checkpoint_stands = 1;
}

bool checkpoint_wished()
{
  return wished != 0;
}

}  // namespace trocar::driver
