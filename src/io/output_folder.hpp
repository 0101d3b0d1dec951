#pragma once

#include <string>

#include "base/files.hpp"

namespace trocar::io {

/// A result folder that is locked for one run. While the object lives, the file `run.lock` with
/// host, process and start time keeps other runs out. A lock that a dead process of this host left
/// behind is taken over. Only files of this program are written or removed, and only in this
/// folder. Use on one rank only.
class OutputFolder
{
 public:
  /// Makes the folder with its subfolder fields, and locks it. Failure (74) when another run has
  /// the lock or a foreign file is in the way, (64) for an empty path.
  explicit OutputFolder(const std::string& path);

  /// Removes field files, checkpoints and run.xdmf of an earlier run, which would mix with the new
  /// results, and the temporary files of a killed run.
  void clear() const;
  /// Removes the field files of an earlier run after step `step`, from which the new run continues,
  /// and the temporary files of a killed run.
  void clear_after(long long step) const;

  const std::string& path() const { return path_; }
  /// Message for the log when a lock was taken over, else empty.
  const std::string& remark() const { return remark_; }

 private:
  void lock();
  void refuse_strangers() const;

  /// The lock file. The destructor removes it.
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
