#include <gtest/gtest.h>

#include "mesh/locator.hpp"
#include "mesh/topology.hpp"
#include "support/block.hpp"

namespace trocar {
namespace {

using core::Vec3;

TEST(Locator, FindsTheTetOfEveryPlaceAndNoneOutside)
{
  const mesh::Mesh mesh = test::block({4, 3, 2, Vec3(0.4, 0.3, 0.2), 0.2});
  const mesh::Locator locator(mesh);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto p = mesh::corners(mesh, t);
    EXPECT_EQ(locator.tet_at(0.3 * p[0] + 0.3 * p[1] + 0.2 * p[2] + 0.2 * p[3]), t);
  }
  EXPECT_EQ(locator.tet_at(Vec3(0.41, 0.1, 0.1)), -1);
  // On a vertex every tet around it would do; the lowest one is taken.
  const auto around = mesh::node_to_tets(mesh);
  for (int node = 0; node < mesh.node_count(); ++node)
    EXPECT_EQ(locator.tet_at(mesh.x[static_cast<std::size_t>(node)]),
              around.tet[static_cast<std::size_t>(around.start[static_cast<std::size_t>(node)])]);
}

}  // namespace
}  // namespace trocar
