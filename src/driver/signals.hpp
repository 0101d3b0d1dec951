#pragma once

#include <string>

namespace trocar::driver {

/// Seconds for which ranks wait for one that does not run.
inline constexpr int most_silence = 20;

/// From here on a closed terminal or pipe does not end the run (SIGPIPE). SIGHUP, SIGINT and
/// SIGTERM end it at once: with 75 when a checkpoint stands, else with 128 + their number;
/// everything written so far is whole at any moment. SIGUSR1 is a wish (see
/// `end_wished`). `speaks`: with one line, for one rank of all.
void handle_signals(bool speaks);

/// From here on the folder has a checkpoint of time t [s]; the line that a signal ends the run with
/// says so.
void checkpoint_stands_at(double t, const std::string& folder);

/// Another rank no longer runs: this one ends at once, with 75 when a checkpoint stands, else
/// with 1.
[[noreturn]] void end_for_silence(int rank, bool speaks);

/// SIGUSR1 came to this rank: the run is to end with a checkpoint after the step.
bool end_wished();

}  // namespace trocar::driver
