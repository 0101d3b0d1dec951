#include <gtest/gtest.h>
#include <mpi.h>

#include "base/petsc.hpp"

// One process per rank: only rank 0 prints, and the verdict is the worst of all ranks.
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();
  MPI_Init(&argc, &argv);
  int verdict = 1;
  {
    const trocar::base::PetscSession petsc(&argc, &argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    if (rank != 0) delete listeners.Release(listeners.default_result_printer());
    verdict = RUN_ALL_TESTS();
    MPI_Allreduce(MPI_IN_PLACE, &verdict, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  }
  MPI_Finalize();
  return verdict;
}
