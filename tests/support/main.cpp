#include <gtest/gtest.h>
#include <mpi.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "base/petsc.hpp"

namespace fs = std::filesystem;

namespace {

/// A folder of the run's own, the same on all ranks, where tests may leave files; gone at the end.
class Scratch
{
 public:
  explicit Scratch(int rank) : rank_(rank)
  {
    auto process = static_cast<long>(getpid());
    MPI_Bcast(&process, 1, MPI_LONG, 0, MPI_COMM_WORLD);
    folder_ = fs::temp_directory_path() / ("trocar_test_" + std::to_string(process));
    if (rank_ == 0) fs::create_directories(folder_);
    MPI_Barrier(MPI_COMM_WORLD);
    fs::current_path(folder_);
  }
  ~Scratch()
  {
    std::error_code ignored;  // nobody is left to be told
    fs::current_path(fs::temp_directory_path(), ignored);
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_ == 0) fs::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

 private:
  int rank_;
  fs::path folder_;
};

}  // namespace

// One process per rank: only rank 0 prints, and the verdict is the worst of all ranks.
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();
  MPI_Init(&argc, &argv);
  int verdict = 1;
  {
    const trocar::base::PetscSession petsc({});
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const Scratch scratch(rank);
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    if (rank != 0) delete listeners.Release(listeners.default_result_printer());
    verdict = RUN_ALL_TESTS();
    MPI_Allreduce(MPI_IN_PLACE, &verdict, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  }
  MPI_Finalize();
  return verdict;
}
