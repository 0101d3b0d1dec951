#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

#include "core/failure.hpp"
#include "core/math.hpp"

namespace trocar::base {

/// A borrowed communicator with its rank and size.
class Comm
{
 public:
  explicit Comm(MPI_Comm comm);
  MPI_Comm get() const noexcept { return comm_; }
  int rank() const noexcept { return rank_; }
  int size() const noexcept { return size_; }
  bool root() const noexcept { return rank_ == 0; }

  double sum(double value) const;      ///< sum over all ranks, in their order; collective
  void sum(core::VecX& values) const;  ///< the same for every entry, in place
  /// Puts together a list of which every entry has its value on one rank and is 0 on the others, in
  /// place. In whatever order MPI adds, the result is the same. For lists as long as a mesh, which
  /// `sum` would hold once for every rank. Collective.
  void merge(core::VecX& values) const;
  double max(double value) const;        ///< largest of all ranks; collective
  void max(core::VecX& values) const;    ///< the same for every entry, in place
  long long sum(long long value) const;  ///< sum over all ranks; collective
  bool all(bool value) const;            ///< collective: true when it is true on every rank
  bool any(bool value) const;            ///< collective: true when it is true on some rank

  /// Joins the values of all ranks in the order of ranks. Rank 0 gets the result, other ranks get
  /// an empty list. Collective.
  std::vector<double> gather(const std::vector<double>& values) const;
  std::vector<int> gather(const std::vector<int>& values) const;

  /// Replaces the values on every rank by those of rank 0. Sizes may differ before. Collective.
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

/// Runs `work` on rank 0 only. If it throws, every rank throws a Failure with the same exit code
/// and line. Collective.
void on_root(const Comm& comm, const std::function<void()>& work);

/// Runs `work` on every rank. If it throws on some ranks, every rank throws the Failure of the
/// lowest of these ranks. Collective, but `work` itself must not be collective.
void on_all(const Comm& comm, const std::function<void()>& work);

}  // namespace trocar::base
