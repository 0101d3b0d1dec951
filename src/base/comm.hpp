#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

#include "core/failure.hpp"
#include "core/math.hpp"

namespace trocar::base {

/// Borrowed communicator with its rank and size.
class Comm
{
 public:
  explicit Comm(MPI_Comm comm);
  MPI_Comm get() const noexcept { return comm_; }
  int rank() const noexcept { return rank_; }
  int size() const noexcept { return size_; }
  bool root() const noexcept { return rank_ == 0; }

  double sum(double value) const;        ///< in the order of ranks; collective, equal on all
  void sum(core::VecX& values) const;    ///< likewise, in place
  double max(double value) const;        ///< collective
  void max(core::VecX& values) const;    ///< collective, in place
  long long sum(long long value) const;  ///< collective
  bool all(bool value) const;            ///< collective: true when it is true on every rank
  bool any(bool value) const;            ///< collective

  /// Every rank's values, one behind the other in the order of ranks, on rank 0; nothing elsewhere.
  /// Collective.
  std::vector<double> gather(const std::vector<double>& values) const;
  std::vector<int> gather(const std::vector<int>& values) const;

  /// Root's values on every rank; sizes may differ before the call. Collective.
  void broadcast(std::vector<double>& values) const;
  void broadcast(std::vector<int>& values) const;
  void broadcast(std::vector<long long>& values) const;
  void broadcast(std::string& text) const;
  void broadcast(std::vector<std::string>& words) const;

 private:
  template <class T>
  void broadcast_array(std::vector<T>& values, MPI_Datatype type) const;
  template <class T>
  std::vector<T> gather_array(const std::vector<T>& values, MPI_Datatype type) const;

  MPI_Comm comm_;
  int rank_ = 0;
  int size_ = 1;
};

/// Runs `work` on rank 0 only; a Failure there is thrown on every rank with the same line.
/// Collective.
void on_root(const Comm& comm, const std::function<void()>& work);

/// Runs `work` on every rank; a Failure on any of them is thrown on all, with the line of the
/// lowest one. Collective; the work itself must not be.
void on_all(const Comm& comm, const std::function<void()>& work);

}  // namespace trocar::base
