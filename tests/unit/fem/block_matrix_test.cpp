#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/petsc.hpp"
#include "support/body.hpp"
#include "support/element_blocks.hpp"

namespace trocar {
namespace {

using test::blocks_of;

void expect_equal_products(const test::Body& body, const fem::BlockMatrix& direct, Mat A)
{
  base::VecHandle x, y;
  TROCAR_PETSC(MatCreateVecs(A, x.out(), y.out()));
  fem::OwnedField field = body.space.zero();
  for (int k = 0; k < body.space.owned_dofs(); ++k)
    field.value[k] = std::sin(3.0 * body.space.first() + k);
  double* data = nullptr;
  TROCAR_PETSC(VecGetArray(x.get(), &data));
  std::copy_n(field.value.data(), field.value.size(), data);
  TROCAR_PETSC(VecRestoreArray(x.get(), &data));
  TROCAR_PETSC(MatMult(A, x.get(), y.get()));
  const double* product = nullptr;
  TROCAR_PETSC(VecGetArrayRead(y.get(), &product));
  const core::VecX theirs = Eigen::Map<const core::VecX>(product, body.space.owned_dofs());
  TROCAR_PETSC(VecRestoreArrayRead(y.get(), &product));
  const fem::OwnedField mine = direct.times(body.space, field);
  EXPECT_LT(body.space.norm({mine.value - theirs}), 1e-13 * body.space.norm(mine));
}

/// An empty matrix of PETSc's for the dofs of a body.
base::MatHandle petsc_matrix(const test::Body& body)
{
  base::MatHandle matrix;
  TROCAR_PETSC(MatCreate(body.comm.get(), matrix.out()));
  Mat A = matrix.get();
  TROCAR_PETSC(MatSetSizes(A, body.space.owned_dofs(), body.space.owned_dofs(), PETSC_DETERMINE,
                           PETSC_DETERMINE));
  TROCAR_PETSC(MatSetType(A, MATAIJ));
  TROCAR_PETSC(MatSetBlockSize(A, 3));
  TROCAR_PETSC(MatSetUp(A));
  TROCAR_PETSC(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  TROCAR_PETSC(MatSetOption(A, MAT_ROW_ORIENTED, PETSC_FALSE));
  return matrix;
}

/// Adds the blocks of one local tet by PETSc's own insertion.
template <int N>
void insert(const test::Body& body, std::size_t e, const core::Mat3& R, Mat A)
{
  const std::vector<int> plain(fem::block_pairs<N>.size(), 0);
  const auto blocks = blocks_of<N>(body.mesh, body.space.file_tet(e), R, plain);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const auto nodes = body.space.nodes(e);
    const int a = nodes[static_cast<std::size_t>(fem::block_pairs<N>[p][0])];
    const int b = nodes[static_cast<std::size_t>(fem::block_pairs<N>[p][1])];
    const PetscInt row = body.space.number(a), column = body.space.number(b);
    const core::Mat3 block = blocks[p].matrix(), transposed = block.transpose();
    // Ranks insert only their own rows, as the program does.
    if (a < body.space.owned())
      TROCAR_PETSC(MatSetValuesBlocked(A, 1, &row, 1, &column, block.data(), ADD_VALUES));
    if (b < body.space.owned() && a != b)
      TROCAR_PETSC(MatSetValuesBlocked(A, 1, &column, 1, &row, transposed.data(), ADD_VALUES));
  }
}

void expect_equal_values(const test::Body& body, const fem::BlockPattern& pattern,
                         const fem::BlockMatrix& direct, Mat A)
{
  double largest = 0.0, difference = 0.0;
  for (int row = 0; row < body.space.owned(); ++row)
    for (int k = pattern.row_start()[static_cast<std::size_t>(row)];
         k < pattern.row_start()[static_cast<std::size_t>(row) + 1]; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const PetscInt r = 3 * (body.space.first() + row) + i;
          const PetscInt c = 3 * pattern.column()[static_cast<std::size_t>(k)] + j;
          double value = 0.0;
          TROCAR_PETSC(MatGetValues(A, 1, &r, 1, &c, &value));
          const double mine = direct.values()[static_cast<std::size_t>(9 * k + 3 * j + i)];
          difference = std::max(difference, std::abs(mine - value));
          largest = std::max(largest, std::abs(value));
        }
  EXPECT_LT(difference, 1e-13 * body.comm.max(largest));
}

// Direct scatter against PETSc's own insertion, element by element.
template <int N>
void expect_petsc_inserts_the_same()
{
  test::BlockShape shape{4, 3, 3, core::Vec3(1.2, 1.0, 0.8), 0.25};
  shape.quadratic = N == 10;
  const test::Body body(shape);
  const fem::BlockPattern pattern(body.space);
  fem::BlockMatrix direct(pattern);
  const base::MatHandle reference = petsc_matrix(body);
  Mat A = reference.get();
  const core::Mat3 R = core::rotation_exp(core::Vec3(0.3, -0.2, 0.9));
  for (std::size_t e = 0; e < body.space.tets(); ++e) {
    direct.add(pattern.slots(e),
               blocks_of<N>(body.mesh, body.space.file_tet(e), R, pattern.slots(e)));
    insert<N>(body, e, R, A);
  }
  TROCAR_PETSC(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  TROCAR_PETSC(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  expect_equal_values(body, pattern, direct, A);
  expect_equal_products(body, direct, A);
}

TEST(BlockMatrix, EqualsMatSetValues)
{
  expect_petsc_inserts_the_same<4>();
  expect_petsc_inserts_the_same<10>();
}

}  // namespace
}  // namespace trocar
