#pragma once

#include <mpi.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace trocar::base {

/// Notices that another rank of this machine no longer runs at all: stopped, or stuck in the
/// kernel. MPI would wait for it for ever. Every rank has a thread that counts in shared memory,
/// once a second, and looks at the others' counts; a rank that computes goes on counting. A job
/// that is stopped as a whole and goes on later is none the worse: time that a rank does not see
/// itself does not count. Ranks on other machines are looked after there.
class Heartbeat
{
 public:
  /// Called with the rank that is silent; it must not return. One of the ranks that call it is to
  /// speak.
  using Silent = std::function<void(int rank, bool speaks)>;

  /// `silent` is called from that thread when a rank has not counted for so many seconds.
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
  MPI_Comm machine_ = MPI_COMM_NULL;  ///< ranks of this machine
  MPI_Win window_ = MPI_WIN_NULL;
  std::vector<int> rank_;                   ///< of each of them in the whole
  std::vector<std::atomic<long>*> counts_;  ///< by each of them
  int own_ = 0;
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::thread thread_;
};

}  // namespace trocar::base
