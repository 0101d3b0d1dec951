#include "driver/signals.hpp"

#include <unistd.h>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <initializer_list>

#include "core/failure.hpp"

namespace trocar::driver {
namespace {

// Data that signal handlers read. One of the two texts is complete while the other is written.
volatile std::sig_atomic_t this_rank_speaks = 0, wished = 0;
// Number of the complete text, 1 or 2; 0: there is no checkpoint.
volatile std::sig_atomic_t checkpoint_text = 0;
std::array<std::array<char, 1024>, 2> texts{};

void say(const char* text)
{
  // A signal handler can do nothing about a failed write.
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

const char* what_stands()
{
  return checkpoint_text ? texts[static_cast<std::size_t>(checkpoint_text - 1)].data()
                         : "what was written until now is whole";
}

int code_of_end(int otherwise)
{
  return checkpoint_text ? static_cast<int>(core::ExitCode::checkpoint) : otherwise;
}

extern "C" void end_with(int signal)
{
  if (this_rank_speaks) {
    say("trocar: error: ended by signal ");
    say(signal == SIGHUP ? "1 (SIGHUP)" : signal == SIGINT ? "2 (SIGINT)" : "15 (SIGTERM)");
    say("; ");
    say(what_stands());
    say("\n");
  }
  ::_exit(code_of_end(128 + signal));
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
  std::signal(SIGXFSZ, SIG_IGN);                // beyond the file size limit a write fails: 74
  for (int signal : {SIGHUP, SIGINT, SIGTERM})  // a signal that nohup ignores stays ignored
    if (std::signal(signal, end_with) == SIG_IGN) std::signal(signal, SIG_IGN);
  struct sigaction action = {};
  action.sa_handler = wish;
  action.sa_flags = SA_RESTART;  // interrupted system calls go on
  ::sigaction(SIGUSR1, &action, nullptr);
}

void end_for_silence(int rank, bool speaks)
{
  const std::string line = "trocar: error: rank " + std::to_string(rank) + " has not run for " +
                           std::to_string(most_silence) +
                           " s (was it stopped?), so nobody can go on; " + what_stands() + "\n";
  if (speaks) say(line.c_str());
  ::_exit(code_of_end(static_cast<int>(core::ExitCode::internal)));
}

void checkpoint_stands_at(double t, const std::string& folder)
{
  const int free = checkpoint_text == 1 ? 2 : 1;
  std::array<char, 1024>& text = texts[static_cast<std::size_t>(free - 1)];
  std::snprintf(text.data(), text.size(),
                "a checkpoint of t = %.6g s stands: -restart %s goes on from it", t,
                folder.c_str());
  std::atomic_signal_fence(std::memory_order_release);  // write the text before its number
  checkpoint_text = free;
}

bool end_wished()
{
  return wished != 0;
}

}  // namespace trocar::driver
