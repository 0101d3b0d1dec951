#include <gtest/gtest.h>

#include "mesh/topology.hpp"
#include "support/block.hpp"

namespace trocar {
namespace {

using core::Vec3;

TEST(Topology, BoundaryOfABlockIsClosedAndOutward)
{
  const mesh::Mesh mesh = test::block({4, 3, 2, Vec3(0.4, 0.3, 0.2), 0.2});
  double volume = 0.0;
  Vec3 sum = Vec3::Zero();
  for (const auto& face : mesh::boundary_faces(mesh)) {
    const Vec3& a = mesh.x[static_cast<std::size_t>(face.nodes[0])];
    const Vec3& b = mesh.x[static_cast<std::size_t>(face.nodes[1])];
    const Vec3& c = mesh.x[static_cast<std::size_t>(face.nodes[2])];
    sum += 0.5 * (b - a).cross(c - a);
    volume += a.dot(b.cross(c)) / 6.0;
  }
  EXPECT_LT(sum.norm(), 1e-15);
  EXPECT_NEAR(volume, 0.024, 1e-15);
  int count = 0;
  mesh::connected_components(mesh, count);
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace trocar
