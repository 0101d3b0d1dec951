#pragma once

#include <string>

#include "base/files.hpp"

namespace trocar::io {

/// A folder for the results of one run at a time. While the object lives, a file `run.lock` with
/// host, process and start time keeps others out; one that a dead process of this host left behind
/// is taken over. Nothing outside the folder is written or removed, and nothing in it that is not
/// ours. For one rank alone.
class OutputFolder
{
 public:
  /// Makes the folder and locks it; touches nothing else. Failure (74): another run has it, or
  /// something is in the way that is not ours; Failure (64) for an empty path.
  explicit OutputFolder(const std::string& path);

  /// Removes field files and checkpoints of an earlier run, which would mix with ours, and what a
  /// killed one left half written.
  void clear() const;
  /// Removes what an earlier run wrote after a step from which ours goes on.
  void clear_after(long long step) const;

  const std::string& path() const { return path_; }
  /// What is to be said: a lock was taken over; "" else.
  const std::string& remark() const { return remark_; }

 private:
  void lock();
  void refuse_strangers() const;

  /// The file with the lock; it goes when its owner does.
  struct Lock
  {
    Lock() = default;
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

    std::string path;
    base::Descriptor file;
  };

  std::string path_, remark_;
  Lock lock_;
};

}  // namespace trocar::io
