#include "base/petsc.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace trocar::base {
namespace {

/// A vector of three numbers in a handle, and one more reference to it that tells who else holds
/// it.
class HandleTest : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    make(first);
    witness = first.get();
    TROCAR_PETSC(PetscObjectReference(reinterpret_cast<PetscObject>(witness)));
  }
  void TearDown() override { TROCAR_PETSC(VecDestroy(&witness)); }

  static void make(VecHandle& handle)
  {
    TROCAR_PETSC(VecCreateSeq(PETSC_COMM_SELF, 3, handle.out()));
  }
  /// Holders of the vector beside this test.
  int holders() const
  {
    PetscInt count = 0;
    TROCAR_PETSC(PetscObjectGetReference(reinterpret_cast<PetscObject>(witness), &count));
    return static_cast<int>(count) - 1;
  }

  VecHandle first;
  Vec witness = nullptr;
};

TEST_F(HandleTest, GivesItsObjectUpWhenMoved)
{
  VecHandle second(std::move(first));
  EXPECT_FALSE(first);
  EXPECT_EQ(second.get(), witness);
  VecHandle third;
  EXPECT_FALSE(third);
  third = std::move(second);
  EXPECT_FALSE(second);
  EXPECT_EQ(third.get(), witness);
  EXPECT_EQ(holders(), 1);
}

TEST_F(HandleTest, DestroysItsObjectAtItsEnd)
{
  EXPECT_EQ(holders(), 1);
  {
    const VecHandle inner(std::move(first));
  }
  EXPECT_EQ(holders(), 0);
}

TEST_F(HandleTest, DestroysWhatItHeldWhenItIsFilledAgain)
{
  make(first);
  EXPECT_EQ(holders(), 0);
  EXPECT_NE(first.get(), witness);
}

TEST_F(HandleTest, DestroysWhatItHeldWhenAnotherIsMovedIn)
{
  VecHandle other;
  make(other);
  const Vec kept = other.get();
  first = std::move(other);
  EXPECT_EQ(holders(), 0);
  EXPECT_EQ(first.get(), kept);
}

TEST_F(HandleTest, StaysWhatItIsWhenMovedIntoItself)
{
  VecHandle& same = first;
  first = std::move(same);
  EXPECT_EQ(first.get(), witness);
  EXPECT_EQ(holders(), 1);
}

// Destroying may be collective, and an exception on its way out may be this rank's alone.
TEST_F(HandleTest, LeavesItsObjectToAnExceptionOnItsWay)
{
  try {
    const VecHandle inner(std::move(first));
    throw std::runtime_error("of this rank");
  } catch (const std::runtime_error&) {
    EXPECT_EQ(holders(), 1);
  }
  Vec left = witness;
  TROCAR_PETSC(VecDestroy(&left));  // nobody else does
}

TEST(CheckedCalls, PetscsErrorsAreSolverFailuresInItsOwnWords)
{
  VecHandle x;
  TROCAR_PETSC(VecCreate(PETSC_COMM_SELF, x.out()));
  try {
    TROCAR_PETSC(VecSetType(x.get(), "no_such_type"));
    ADD_FAILURE() << "an unknown type was accepted";
  } catch (const core::Failure& failure) {
    const std::string line = failure.what();
    EXPECT_EQ(failure.code(), core::ExitCode::solver);
    EXPECT_NE(line.find("no_such_type"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(CheckedCalls, MpisErrorsNameTheCall)
{
  EXPECT_NO_THROW(TROCAR_MPI(MPI_SUCCESS));
  try {
    check_mpi(MPI_ERR_COUNT, "MPI_Bcast(…)");
    ADD_FAILURE() << "an error was accepted";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::internal);
    EXPECT_NE(std::string(failure.what()).find("MPI_Bcast(…)"), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::base
