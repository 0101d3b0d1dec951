#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.hpp"
#include "io/xdmf.hpp"

namespace trocar::io {

/// All that a run needs to go on from the end of a step as if it had never stopped.
struct Checkpoint
{
  /// An option as it was used; of a file what was in it as well.
  struct Option
  {
    std::string name, value, hash;
  };
  /// How the run counts its steps.
  struct Time
  {
    double now = 0.0;        ///< [s]
    double step = 0.0;       ///< h [s]
    double asked = 0.0;      ///< h as it was asked for [s]
    double end = 0.0;        ///< [s]
    long long nominal = 0;   ///< steps of full length that are done
    long long accepted = 0;  ///< steps that are done, parts of halved ones each for itself
  };

  /// run.h5 as it was then: what of it stays as it is adds up to `sum`. What does not are the
  /// places below and rows that come later.
  struct RunFile
  {
    long long bytes = 0;  ///< its length
    long long rows = 0;   ///< of the histories
    long long room = 0;   ///< rows that they have room for
    std::string id;       ///< of the run that made it
    std::string sum;
    std::vector<long long> series;  ///< data, row count [B] and columns of each history
    std::vector<long long> ledger;  ///< of each count [B]
  };

  std::string version;  ///< of the program that wrote it
  std::vector<Option> options;
  Time time;
  RunFile run;
  std::vector<std::pair<std::string, long long>> ledger;
  std::vector<XdmfFrame> frames;  ///< that run.xdmf shows
  core::Archive state;
};

/// Names of what belongs to checkpoints in a result folder.
bool names_checkpoint(const std::string& name);

/// Puts a checkpoint into a result folder. There are two files in turn, each written under another
/// name, synced and renamed; `checkpoint.txt` is put in place last and names the good one, its
/// length and its sum. Whatever the moment a run is killed, the last one that was finished stands.
/// Failure (74), and the one before stands. For one rank alone.
void write_checkpoint(const std::string& folder, const Checkpoint& checkpoint);

/// The last one that was finished in a folder. Failure (65) with the file and what is wrong where
/// there is none, where it is damaged, or another program's. For one rank alone.
Checkpoint read_checkpoint(const std::string& folder);

}  // namespace trocar::io
