#pragma once

#include <string>

namespace trocar::driver {

/// How long ranks wait for a rank that does not run [s].
inline constexpr int most_silence = 20;

/// Installs the signal handlers. A write to a closed pipe or terminal no longer ends the run
/// (SIGPIPE is ignored). SIGHUP, SIGINT and SIGTERM end it at once, with exit code 75 when there is
/// a checkpoint, else with 128 + their number. Files need no clean-up, because they are complete at
/// any moment. SIGUSR1 asks for an early end, see `end_wished`. `speaks`: this rank prints the line
/// on the end; true on one rank only.
void handle_signals(bool speaks);

/// Tells the signal handlers that the folder has a checkpoint of time t [s]. The line that they
/// print then names it.
void checkpoint_stands_at(double t, const std::string& folder);

/// Ends this rank at once, because the rank `rank` no longer runs: with exit code 75 when there is
/// a checkpoint, else with 1.
[[noreturn]] void end_for_silence(int rank, bool speaks);

/// True after this rank received SIGUSR1: the run is to end with a checkpoint after the present
/// step.
bool end_wished();

}  // namespace trocar::driver
