#include "base/heartbeat.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <vector>

#include "base/comm.hpp"

namespace trocar::base {
namespace {

// A rank that is stopped for longer than the others wait is told of by its number, and only then;
// while everybody computes nobody is. With the last rank stopped the first one speaks.
TEST(Heartbeat, TellsOfARankThatIsStopped)
{
  const Comm comm(MPI_COMM_WORLD);
  const int last = comm.size() - 1;
  std::atomic<int> silent = -1, speakers = 0;
  std::vector<double> pids{static_cast<double>(getpid())};
  pids = comm.gather(pids);
  {
    const Heartbeat heartbeat(MPI_COMM_WORLD, 2, [&](int rank, bool speaks) {
      silent = rank;
      speakers += speaks ? 1 : 0;
    });
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_EQ(silent, -1);
    MPI_Barrier(MPI_COMM_WORLD);
    if (comm.root() && last > 0) {
      const auto pid = static_cast<pid_t>(pids.back());
      kill(pid, SIGSTOP);
      for (int tick = 0; tick < 80 && silent < 0; ++tick)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      kill(pid, SIGCONT);
      EXPECT_EQ(silent, last);
      EXPECT_GE(speakers, 1);
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }
  EXPECT_EQ(speakers > 0, comm.root() && last > 0);
}

}  // namespace
}  // namespace trocar::base
