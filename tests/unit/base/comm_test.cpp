#include "base/comm.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <utility>

namespace trocar::base {
namespace {

using core::ExitCode;
using core::Failure;

/// The code and line that `work` is refused with on this rank.
std::pair<ExitCode, std::string> refusal(const std::function<void()>& work)
{
  try {
    work();
  } catch (const Failure& failure) {
    return {failure.code(), failure.what()};
  }
  return {ExitCode::ok, ""};
}

TEST(Reductions, AreEqualOnEveryRank)
{
  const Comm comm(MPI_COMM_WORLD);
  const int n = comm.size();
  EXPECT_EQ(comm.sum(0.5 * (comm.rank() + 1)), 0.25 * n * (n + 1));
  EXPECT_EQ(comm.sum(1LL << 40), static_cast<long long>(n) << 40);  // beyond 32 bits
  EXPECT_EQ(comm.max(-1.0 - comm.rank()), -1.0);
  core::VecX values = core::VecX::Constant(3, comm.rank());
  values[1] = 1.0;
  comm.sum(values);
  EXPECT_EQ(values, core::Vec3(0.5 * n * (n - 1), n, 0.5 * n * (n - 1)));
}

// In the order of ranks: 1e16 swallows every 1 that comes after it, none that came before together.
TEST(Reductions, SumInTheOrderOfRanks)
{
  const Comm comm(MPI_COMM_WORLD);
  const auto of = [&](int rank) { return rank == comm.size() - 1 ? 1e16 : 1.0 + 1e-3 * rank; };
  double wanted = of(0);
  for (int rank = 1; rank < comm.size(); ++rank) wanted += of(rank);
  EXPECT_EQ(comm.sum(of(comm.rank())), wanted);
}

TEST(Reductions, PutTogetherWhatRanksHaveOfAList)
{
  const Comm comm(MPI_COMM_WORLD);
  const int n = comm.size();
  core::VecX mine = core::VecX::Zero(n);
  mine[comm.rank()] = 0.1 * (comm.rank() + 1);
  comm.merge(mine);
  core::VecX largest = core::VecX::Constant(2, -1.0 - comm.rank());
  largest[1] = comm.rank();
  comm.max(largest);
  EXPECT_EQ(largest, core::VecX(Eigen::Vector2d(-1.0, n - 1)));
  // Rank r has r numbers.
  std::vector<double> numbers(static_cast<std::size_t>(comm.rank()), 0.5 * comm.rank());
  numbers = comm.gather(numbers);
  EXPECT_EQ(numbers.size(), comm.root() ? static_cast<std::size_t>(n * (n - 1) / 2) : 0U);
  std::size_t at = 0;
  for (int rank = 0; rank < n; ++rank) {
    EXPECT_EQ(mine[rank], 0.1 * (rank + 1));
    for (int k = 0; comm.root() && k < rank; ++k) EXPECT_EQ(numbers[at++], 0.5 * rank);
  }
}

TEST(Reductions, AskEveryRank)
{
  const Comm comm(MPI_COMM_WORLD);
  EXPECT_TRUE(comm.all(true));
  EXPECT_FALSE(comm.any(false));
  for (int one = 0; one < comm.size(); ++one) {
    EXPECT_FALSE(comm.all(comm.rank() != one)) << one;
    EXPECT_TRUE(comm.any(comm.rank() == one)) << one;
  }
}

// What the other ranks hold before counts for nothing, not even its size.
TEST(Broadcast, BringsRootsValuesToEveryRank)
{
  const Comm comm(MPI_COMM_WORLD);
  std::vector<double> numbers(static_cast<std::size_t>(5 * comm.rank()), -1.0);
  std::vector<long long> long_numbers(7, comm.rank());
  std::vector<std::string> words(static_cast<std::size_t>(comm.rank()), "mine");
  std::string text = "rank " + std::to_string(comm.rank());
  std::vector<int> none(static_cast<std::size_t>(comm.rank()), 1);
  if (comm.root()) {
    numbers = {1.5, -2.0, 1e300};
    long_numbers = {1LL << 50};
    words = {"liver", "", "µ and a blank"};
  }
  comm.broadcast(numbers);
  comm.broadcast(long_numbers);
  comm.broadcast(words);
  comm.broadcast(text);
  comm.broadcast(none);
  EXPECT_EQ(numbers, (std::vector<double>{1.5, -2.0, 1e300}));
  EXPECT_EQ(long_numbers, (std::vector<long long>{1LL << 50}));
  EXPECT_EQ(words, (std::vector<std::string>{"liver", "", "µ and a blank"}));
  EXPECT_EQ(text, "rank 0");
  EXPECT_TRUE(none.empty());
}

TEST(AgreedFailures, OfRootAreThrownOnEveryRankWithTheSameLine)
{
  const Comm comm(MPI_COMM_WORLD);
  int calls = 0;
  on_root(comm, [&] { ++calls; });
  EXPECT_EQ(calls, comm.root() ? 1 : 0);
  for (ExitCode code : {ExitCode::options, ExitCode::data, ExitCode::solver, ExitCode::output}) {
    const auto caught = refusal([&] {
      on_root(comm, [&] { throw Failure(code, "mesh.msh: line " + std::to_string(comm.rank())); });
    });
    EXPECT_EQ(caught.first, code);
    EXPECT_EQ(caught.second, "mesh.msh: line 0");
  }
  EXPECT_EQ(comm.sum(1.0), comm.size());  // nobody is left behind
}

TEST(AgreedFailures, OfSeveralRanksAreThoseOfTheLowest)
{
  const Comm comm(MPI_COMM_WORLD);
  for (int lowest = 0; lowest < comm.size(); ++lowest) {
    const auto caught = refusal([&] {
      on_all(comm, [&] {
        if (comm.rank() >= lowest)
          throw core::output_error("the disk of rank " + std::to_string(comm.rank()) + " is full");
      });
    });
    EXPECT_EQ(caught.first, ExitCode::output);
    EXPECT_EQ(caught.second, "the disk of rank " + std::to_string(lowest) + " is full");
  }
}

TEST(AgreedFailures, NeedOne)
{
  const Comm comm(MPI_COMM_WORLD);
  int calls = 0;
  EXPECT_NO_THROW(on_all(comm, [&] { ++calls; }));
  EXPECT_EQ(calls, 1);
}

TEST(AgreedFailures, OfUnknownKindAreInternal)
{
  const Comm comm(MPI_COMM_WORLD);
  const auto of_last = refusal([&] {
    on_all(comm, [&] {
      if (comm.rank() == comm.size() - 1) throw std::out_of_range("row 7");
    });
  });
  EXPECT_EQ(of_last.first, ExitCode::internal);
  EXPECT_EQ(of_last.second, "row 7");
}

TEST(AgreedFailures, OfMemoryAndFileSystemsHaveCodesOfTheirOwn)
{
  const Comm comm(MPI_COMM_WORLD);
  const auto of_memory = refusal([&] { on_root(comm, [] { throw std::bad_alloc(); }); });
  EXPECT_EQ(of_memory.first, ExitCode::solver);
  EXPECT_EQ(of_memory.second, "the memory does not suffice");
  const auto of_files = refusal([&] {
    on_root(comm, [] { static_cast<void>(std::filesystem::file_size("no_such_file")); });
  });
  EXPECT_EQ(of_files.first, ExitCode::output);
}

}  // namespace
}  // namespace trocar::base
