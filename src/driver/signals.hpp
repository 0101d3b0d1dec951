#pragma once

namespace trocar::driver {

/// From here on a closed terminal or pipe does not end the run (SIGPIPE), and SIGHUP, SIGINT and
/// SIGTERM end it at once with 128 + their number: everything written so far is whole at any
/// moment. `speaks`: with one line, for one rank of all.
void handle_signals(bool speaks);

}  // namespace trocar::driver
