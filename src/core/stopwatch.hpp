#pragma once

#include <chrono>
#include <ctime>

namespace trocar::core {

/// Wall time since construction [s].
class Stopwatch
{
 public:
  double seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor time of this thread since construction [s]. It stands still while other threads use
/// the processor.
class ProcessorStopwatch
{
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace trocar::core
