#include <gtest/gtest.h>

#include "base/petsc.hpp"
#include "support/body.hpp"
#include "tissue/element_blocks.hpp"

namespace trocar {
namespace {

const test::BlockShape distorted{4, 3, 3, core::Vec3(1.2, 1.0, 0.8), 0.25};

/// K turned by R plus 1e3 M of a tet; transposed as the slots say.
template <int N>
fem::ElementBlocks<N> blocks_of(const mesh::Mesh& mesh, int tet, const core::Mat3& R,
                                std::span<const int> slots)
{
  const tissue::Material m;
  const auto shapes = fem::point_shapes<N>(mesh, tet);
  std::array<core::Mat3, fem::points_per_tet<N>> turns;
  turns.fill(R);
  Eigen::Matrix<double, N, N> mass = Eigen::Matrix<double, N, N>::Constant(0.05);
  mass.diagonal() *= 2.0;
  return tissue::operator_blocks<N>(m.lambda(), m.mu(), shapes.data(), turns.data(),
                                    mesh::tet_volume(mesh, tet) * mass, 1e3 * m.density, slots);
}

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

TEST(Space, EveryNodeHasOneOwnerAndGhostsArrive)
{
  const test::Body body(distorted);
  EXPECT_EQ(body.comm.sum(static_cast<long long>(body.space.owned())), body.mesh.node_count());
  fem::OwnedField x = body.space.zero();
  for (int i = 0; i < body.space.owned(); ++i)
    x.node(i) = body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))];
  const auto ghosted = body.space.with_ghosts(x);
  for (int i = 0; i < body.space.local(); ++i)
    EXPECT_EQ(core::Vec3(ghosted.node(i)),
              body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))]);
  const auto global = body.space.gather(x);
  for (int i = 0; i < body.mesh.node_count(); ++i)
    EXPECT_EQ(core::Vec3(global.node(i)), body.mesh.x[static_cast<std::size_t>(i)]);
  EXPECT_EQ(body.space.restrict_to_owned(global).value, x.value);
}

TEST(Space, RanksWithoutTetsAreAllowed)
{
  const test::Body body({1, 1, 1});
  EXPECT_EQ(body.comm.sum(static_cast<long long>(body.space.owned())), 8);
  EXPECT_EQ(body.space.gather(body.space.zero()).value.size(), 24);
}

// Direct scatter against PETSc's own insertion, element by element.
template <int N>
void expect_petsc_inserts_the_same()
{
  test::BlockShape shape = distorted;
  shape.quadratic = N == 10;
  const test::Body body(shape);
  const fem::BlockPattern pattern(body.space);
  fem::BlockMatrix direct(pattern);
  base::MatHandle reference;
  TROCAR_PETSC(MatCreate(body.comm.get(), reference.out()));
  Mat A = reference.get();
  TROCAR_PETSC(MatSetSizes(A, body.space.owned_dofs(), body.space.owned_dofs(), PETSC_DETERMINE,
                           PETSC_DETERMINE));
  TROCAR_PETSC(MatSetType(A, MATAIJ));
  TROCAR_PETSC(MatSetBlockSize(A, 3));
  TROCAR_PETSC(MatSetUp(A));
  TROCAR_PETSC(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  TROCAR_PETSC(MatSetOption(A, MAT_ROW_ORIENTED, PETSC_FALSE));
  const core::Mat3 R = core::rotation_exp(core::Vec3(0.3, -0.2, 0.9));
  for (std::size_t e = 0; e < body.space.tets(); ++e) {
    const int tet = body.space.file_tet(e);
    direct.add(pattern.slots(e), blocks_of<N>(body.mesh, tet, R, pattern.slots(e)));
    const std::vector<int> plain(pattern.slots(e).size(), 0);
    const auto blocks = blocks_of<N>(body.mesh, tet, R, plain);
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
  TROCAR_PETSC(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  TROCAR_PETSC(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
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

  expect_equal_products(body, direct, A);
}

TEST(BlockMatrix, EqualsMatSetValues)
{
  expect_petsc_inserts_the_same<4>();
  expect_petsc_inserts_the_same<10>();
}

TEST(Element, BlocksEqualTheTextbookStrainMatrix)
{
  const test::Body body({2, 2, 2, core::Vec3::Ones(), 0.2});
  core::MatX A = core::MatX::Zero(3 * body.mesh.node_count(), 3 * body.mesh.node_count());
  for (int t = 0; t < body.mesh.tet_count(); ++t) {
    const auto blocks = blocks_of<4>(body.mesh, t, core::Mat3::Identity(), std::vector<int>(10, 0));
    const auto& tet = body.mesh.tets[static_cast<std::size_t>(t)];
    for (std::size_t p = 0; p < 10; ++p) {
      const int a = tet[static_cast<std::size_t>(fem::block_pairs<4>[p][0])];
      const int b = tet[static_cast<std::size_t>(fem::block_pairs<4>[p][1])];
      A.block<3, 3>(3 * a, 3 * b) += blocks[p].matrix();
      if (a != b) A.block<3, 3>(3 * b, 3 * a) += blocks[p].matrix().transpose();
    }
  }
  const core::MatX reference = test::dense_operator(body.mesh, {}, 1.0, 1e3);
  EXPECT_LT((A - reference).norm(), 1e-13 * reference.norm());
}

// First Piola stress of a law in its own terms.
core::Mat3 stress_of(tissue::Model model, const tissue::Material& m, const core::Mat3& F)
{
  const core::Mat3 R =
      model == tissue::Model::linear ? core::Mat3::Identity() : core::polar_rotation(F);
  return m.mu() * tissue::energy::shear_gradient(model, R, F - core::Mat3::Identity()) +
         m.lambda() * tissue::energy::dilatation(model, R, F - core::Mat3::Identity()) *
             tissue::energy::dilatation_gradient(model, R, F - core::Mat3::Identity());
}

double energy_of(tissue::Model model, const tissue::Material& m, const core::Mat3& F)
{
  const core::Mat3 R =
      model == tissue::Model::linear ? core::Mat3::Identity() : core::polar_rotation(F);
  const double theta = tissue::energy::dilatation(model, R, F - core::Mat3::Identity());
  return m.mu() * tissue::energy::shear(model, R, F - core::Mat3::Identity()) +
         0.5 * m.lambda() * theta * theta;
}

// A turned body answers as the unturned one does in its own axes; stress is the derivative of the
// energy; near F = I every law is Hooke's.
TEST(Material, StressIsObjectiveAndTheDerivativeOfTheEnergy)
{
  const tissue::Material m{4000.0, 0.3, 1000.0, 0.0, 0.0};
  const core::Mat3 Q = core::rotation_exp(core::Vec3(1.0, -0.4, 0.3));
  core::Mat3 F;
  F << 1.1, 0.2, 0.0, -0.1, 0.95, 0.05, 0.02, 0.1, 1.2;
  const core::Mat3 e = 0.5 * (F + F.transpose()) - core::Mat3::Identity();
  const core::Mat3 hooke = 2.0 * m.mu() * e + m.lambda() * e.trace() * core::Mat3::Identity();
  for (const auto model :
       {tissue::Model::linear, tissue::Model::corotational, tissue::Model::neo_hookean}) {
    const core::Mat3 P = stress_of(model, m, F);
    if (model != tissue::Model::linear) {
      EXPECT_LT((stress_of(model, m, Q * F) - Q * P).norm(), 1e-10 * P.norm());
    }
    const double little = 1e-7;
    const core::Mat3 near = core::Mat3::Identity() + little * (F - core::Mat3::Identity());
    EXPECT_LT((stress_of(model, m, near) / little - hooke).norm(), 1e-5 * hooke.norm());
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        core::Mat3 d = core::Mat3::Zero();
        d(i, j) = 1e-6;
        EXPECT_NEAR((energy_of(model, m, F + d) - energy_of(model, m, F - d)) / 2e-6, P(i, j),
                    1e-6 * P.norm());
      }
  }
}

}  // namespace
}  // namespace trocar
