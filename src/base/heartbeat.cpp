#include "base/heartbeat.hpp"

#include <chrono>
#include <new>
#include <utility>
#include <vector>

#include "base/petsc.hpp"

namespace trocar::base {

static_assert(std::atomic<long>::is_always_lock_free, "counts are shared by processes");

Heartbeat::Heartbeat(MPI_Comm comm, int seconds, Silent silent)
    : seconds_(seconds), silent_(std::move(silent))
{
  int mine = 0, size = 0;
  TROCAR_MPI(MPI_Comm_rank(comm, &mine));
  TROCAR_MPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, mine, MPI_INFO_NULL, &machine_));
  TROCAR_MPI(MPI_Comm_size(machine_, &size));
  if (size == 1) return;
  TROCAR_MPI(MPI_Comm_rank(machine_, &own_));
  void* memory = nullptr;
  // A machine without shared memory for MPI goes without a heartbeat.
  TROCAR_MPI(MPI_Comm_set_errhandler(machine_, MPI_ERRORS_RETURN));
  int here = MPI_Win_allocate_shared(sizeof(std::atomic<long>), 1, MPI_INFO_NULL, machine_, &memory,
                                     &window_) == MPI_SUCCESS;
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, &here, 1, MPI_INT, MPI_MIN, machine_));
  if (!here) return;
  new (memory) std::atomic<long>(0);
  rank_.resize(static_cast<std::size_t>(size));
  TROCAR_MPI(MPI_Allgather(&mine, 1, MPI_INT, rank_.data(), 1, MPI_INT, machine_));
  for (int other = 0; other < size; ++other) {
    MPI_Aint bytes = 0;
    int unit = 0;
    TROCAR_MPI(MPI_Win_shared_query(window_, other, &bytes, &unit, &memory));
    counts_.push_back(static_cast<std::atomic<long>*>(memory));
  }
  thread_ = std::thread([this] { watch(); });
}

Heartbeat::~Heartbeat()
{
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    ended_.notify_one();
    thread_.join();
  }
  // A count of -1 tells the other ranks that this rank ended normally.
  if (!counts_.empty()) counts_[static_cast<std::size_t>(own_)]->store(-1);
  if (window_ != MPI_WIN_NULL) MPI_Win_free(&window_);
  if (machine_ != MPI_COMM_NULL) MPI_Comm_free(&machine_);
}

void Heartbeat::watch()
{
  std::vector<long> seen(counts_.size(), 0);
  std::vector<int> silent(counts_.size(), 0);  // seconds without a new count, by rank
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, std::chrono::seconds(1), [this] { return over_; })) {
    counts_[static_cast<std::size_t>(own_)]->fetch_add(1);
    for (std::size_t other = 0; other < counts_.size(); ++other) {
      const long count = counts_[other]->load();
      silent[other] = count == seen[other] && count >= 0 ? silent[other] + 1 : 0;
      seen[other] = count;
      const std::size_t speaker = other == 0 ? 1 : 0;
      if (silent[other] >= seconds_)
        silent_(rank_[other], static_cast<std::size_t>(own_) == speaker);
    }
  }
}

}  // namespace trocar::base
