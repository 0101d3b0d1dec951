#include "base/comm.hpp"

#include <algorithm>
#include <climits>
#include <exception>
#include <filesystem>
#include <new>
#include <numeric>

#include "base/petsc.hpp"

namespace trocar::base {
namespace {

/// A caught failure as plain data that can be sent to other ranks.
struct Caught
{
  int code = 0;
  std::string line;
};

Caught run_guarded(const std::function<void()>& work)
{
  try {
    work();
    return {};
  } catch (const core::Failure& failure) {
    return {static_cast<int>(failure.code()), failure.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return {static_cast<int>(core::ExitCode::output), core::printable(error.what())};
  } catch (const std::bad_alloc&) {
    return {static_cast<int>(core::ExitCode::solver), "the memory does not suffice"};
  } catch (const std::exception& error) {
    return {static_cast<int>(core::ExitCode::internal), core::printable(error.what())};
  }
}

void broadcast_from(const Comm& comm, int source, Caught& caught)
{
  TROCAR_MPI(MPI_Bcast(&caught.code, 1, MPI_INT, source, comm.get()));
  int length = static_cast<int>(caught.line.size());
  TROCAR_MPI(MPI_Bcast(&length, 1, MPI_INT, source, comm.get()));
  caught.line.resize(static_cast<std::size_t>(length));
  TROCAR_MPI(MPI_Bcast(caught.line.data(), length, MPI_CHAR, source, comm.get()));
}

}  // namespace

Comm::Comm(MPI_Comm comm) : comm_(comm)
{
  TROCAR_MPI(MPI_Comm_rank(comm, &rank_));
  TROCAR_MPI(MPI_Comm_size(comm, &size_));
}

double Comm::sum(double value) const
{
  core::VecX one = core::VecX::Constant(1, value);
  sum(one);
  return one[0];
}

// The MPI standard recommends, but does not demand, that a reduction gives the same bits in every
// run. Here the order is always that of the ranks.
void Comm::sum(core::VecX& values) const
{
  if (size_ == 1) return;
  core::MatX all(values.size(), size_);
  TROCAR_MPI(MPI_Allgather(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, all.data(),
                           static_cast<int>(values.size()), MPI_DOUBLE, comm_));
  values = all.col(0);
  for (int rank = 1; rank < size_; ++rank) values += all.col(rank);
}

void Comm::merge(core::VecX& values) const
{
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE,
                           MPI_SUM, comm_));
}

long long Comm::sum(long long value) const
{
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_LONG_LONG, MPI_SUM, comm_));
  return value;
}

double Comm::max(double value) const
{
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm_));
  return value;
}

void Comm::max(core::VecX& values) const
{
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE,
                           MPI_MAX, comm_));
}

bool Comm::all(bool value) const
{
  int flag = value ? 1 : 0;
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MIN, comm_));
  return flag == 1;
}

bool Comm::any(bool value) const
{
  return !all(!value);
}

template <class T>
void Comm::broadcast_array(std::vector<T>& values, MPI_Datatype type) const
{
  long long size = static_cast<long long>(values.size());
  TROCAR_MPI(MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, comm_));
  values.resize(static_cast<std::size_t>(size));
  for (long long at = 0; at < size; at += INT_MAX / 2) {
    const int count = static_cast<int>(std::min<long long>(INT_MAX / 2, size - at));
    TROCAR_MPI(MPI_Bcast(values.data() + at, count, type, 0, comm_));
  }
}

void Comm::broadcast(std::vector<double>& values) const
{
  broadcast_array(values, MPI_DOUBLE);
}
void Comm::broadcast(std::vector<int>& values) const
{
  broadcast_array(values, MPI_INT);
}
template <class T>
std::vector<T> Comm::gather_array(const std::vector<T>& values, MPI_Datatype type) const
{
  const int mine = static_cast<int>(values.size());
  std::vector<int> counts(static_cast<std::size_t>(size_)), starts(counts.size(), 0);
  TROCAR_MPI(MPI_Gather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm_));
  std::vector<T> all;
  if (root()) {
    std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
    all.resize(static_cast<std::size_t>(starts.back() + counts.back()));
  }
  TROCAR_MPI(MPI_Gatherv(values.data(), mine, type, all.data(), counts.data(), starts.data(), type,
                         0, comm_));
  return all;
}

std::vector<double> Comm::gather(const std::vector<double>& values) const
{
  return gather_array(values, MPI_DOUBLE);
}

std::vector<int> Comm::gather(const std::vector<int>& values) const
{
  return gather_array(values, MPI_INT);
}

void Comm::broadcast(std::vector<long long>& values) const
{
  broadcast_array(values, MPI_LONG_LONG);
}

void Comm::broadcast(std::string& text) const
{
  std::vector<char> bytes(text.begin(), text.end());
  broadcast_array(bytes, MPI_CHAR);
  text.assign(bytes.begin(), bytes.end());
}

void Comm::broadcast(std::vector<std::string>& words) const
{
  std::string text;
  std::vector<int> lengths;
  for (const std::string& word : words) {
    text += word;
    lengths.push_back(static_cast<int>(word.size()));
  }
  broadcast(lengths);
  broadcast(text);
  words.clear();
  std::size_t at = 0;
  for (int length : lengths) {
    words.push_back(text.substr(at, static_cast<std::size_t>(length)));
    at += static_cast<std::size_t>(length);
  }
}

void on_root(const Comm& comm, const std::function<void()>& work)
{
  Caught caught;
  if (comm.root()) caught = run_guarded(work);
  broadcast_from(comm, 0, caught);
  if (caught.code != 0) throw core::Failure(static_cast<core::ExitCode>(caught.code), caught.line);
}

void on_all(const Comm& comm, const std::function<void()>& work)
{
  Caught caught = run_guarded(work);
  const int mine = caught.code != 0 ? comm.rank() : comm.size();
  int first = 0;
  TROCAR_MPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm.get()));
  if (first == comm.size()) return;
  broadcast_from(comm, first, caught);
  throw core::Failure(static_cast<core::ExitCode>(caught.code), caught.line);
}

}  // namespace trocar::base
