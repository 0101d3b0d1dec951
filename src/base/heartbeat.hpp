#pragma once

#include <mpi.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace trocar::base {

/// Detects another rank on the same machine that no longer runs, because it was stopped or hangs in
/// the kernel. MPI would wait for such a rank for ever. Every rank has a thread that increments a
/// count in shared memory once a second and reads the counts of the other ranks. A rank that
/// computes keeps counting. A rank measures the silence of others only while its own thread runs,
/// so a job that is stopped as a whole may continue later. Each machine checks its own ranks.
class Heartbeat
{
 public:
  /// Called with the silent rank on every rank that notices the silence; must not return. `speaks`
  /// is true on one of these ranks, which prints the message.
  using Silent = std::function<void(int rank, bool speaks)>;

  /// Starts the thread. It calls `silent` when another rank has not counted for `seconds`.
  /// Collective.
  Heartbeat(MPI_Comm comm, int seconds, Silent silent);
  /// Collective.
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void watch();

  int seconds_;
  Silent silent_;
  MPI_Comm machine_ = MPI_COMM_NULL;  ///< the ranks on this machine
  MPI_Win window_ = MPI_WIN_NULL;
  std::vector<int> rank_;  ///< rank in the constructor's `comm`, by rank on this machine
  std::vector<std::atomic<long>*> counts_;  ///< counts in shared memory, by rank on this machine
  int own_ = 0;
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::thread thread_;
};

}  // namespace trocar::base
