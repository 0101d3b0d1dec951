#include "driver/signals.hpp"

#include <unistd.h>
#include <csignal>
#include <cstring>
#include <initializer_list>

namespace trocar::driver {
namespace {

volatile std::sig_atomic_t this_rank_speaks = 0;

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
    say("; what was written until now is whole\n");
  }
  ::_exit(128 + signal);
}

}  // namespace

void handle_signals(bool speaks)
{
  this_rank_speaks = speaks ? 1 : 0;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);                // a file that may grow no more fails the write: 74
  for (int signal : {SIGHUP, SIGINT, SIGTERM})  // what nohup has ignored stays so
    if (std::signal(signal, end_with) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace trocar::driver
