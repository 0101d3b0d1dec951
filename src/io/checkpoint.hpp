#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.hpp"
#include "io/xdmf.hpp"

namespace trocar::io {

/// Everything that a run needs to continue from the end of a step as if it had never stopped.
struct Checkpoint
{
  /// An option as the run used it. `hash`: FNV-1a of the contents when the value names a file, else
  /// empty.
  struct Option
  {
    std::string name, value, hash;

    bool operator==(const Option&) const = default;
  };
  /// Time and step counts of the run.
  struct Time
  {
    double now = 0.0;        ///< time of the state [s]
    double step = 0.0;       ///< step length h [s]
    double end = 0.0;        ///< end of the run [s]
    long long nominal = 0;   ///< completed steps of full length
    long long accepted = 0;  ///< accepted steps; each part of a halved step counts

    bool operator==(const Time&) const = default;
  };

  /// run.h5 at the time of the checkpoint. `sum` is the FNV-1a of its bytes, with zeros in place of
  /// what changes later: row counts, ledger counts and the room for later rows.
  struct RunFile
  {
    long long bytes = 0;  ///< size of the file [B]
    long long rows = 0;   ///< rows in each history
    long long room = 0;   ///< rows for which the histories have room
    std::string id;       ///< run id of the run that made the file
    std::string sum;
    /// Per history: offset of the data [B], offset of the row count [B], columns.
    std::vector<long long> series;
    std::vector<long long> ledger;  ///< offset of each ledger count [B]

    bool operator==(const RunFile&) const = default;
  };

  std::string version;  ///< of the program that wrote the checkpoint
  std::vector<Option> options;
  Time time;
  RunFile run;
  std::vector<std::pair<std::string, long long>> ledger;
  std::vector<XdmfFrame> frames;  ///< frames of run.xdmf
  core::Archive state;

  bool operator==(const Checkpoint&) const = default;
};

/// True when `name` is checkpoint.txt or one of the two checkpoint files.
bool names_checkpoint(const std::string& name);

/// Writes a checkpoint into a result folder. Two files are used in turn; each is written under a
/// temporary name, synced and renamed. `checkpoint.txt` is replaced last and names the complete
/// file, its size and its checksum. So the last complete checkpoint survives a kill at any moment.
/// Throws Failure (74); the previous checkpoint then remains. Failure (65) when the present
/// checkpoint.txt is damaged. Call on one rank only.
void write_checkpoint(const std::string& folder, const Checkpoint& checkpoint);

/// Reads the last complete checkpoint of a folder. Failure (65), with the file and the reason, when
/// there is none, when it is damaged or when its format is not that of this program. Call on one
/// rank only.
Checkpoint read_checkpoint(const std::string& folder);

}  // namespace trocar::io
