#include <gtest/gtest.h>

#include "support/body.hpp"
#include "support/element_blocks.hpp"

namespace trocar {
namespace {

using test::blocks_of;

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

}  // namespace
}  // namespace trocar
