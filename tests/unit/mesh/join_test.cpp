#include <gtest/gtest.h>

#include "core/failure.hpp"
#include "mesh/join.hpp"
#include "support/block.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// A block of one cell whose groups have names of their own.
mesh::Mesh named(const std::string& name, bool quadratic, double up)
{
  test::BlockShape shape{1, 1, 1, Vec3::Constant(0.01)};
  shape.quadratic = quadratic;
  shape.map = [up](const Vec3& X) { return Vec3(X + Vec3(0, 0, up)); };
  mesh::Mesh mesh = test::block(shape);
  mesh.file = name + ".msh";
  mesh.hash = name;
  mesh.volumes = {name};
  mesh.file_of = {mesh.file};
  mesh.remarks = {"small"};
  for (mesh::SurfaceGroup& surface : mesh.surfaces) surface.name = name + "_" + surface.name;
  for (mesh::PointGroup& point : mesh.points) point.name = name + "_" + point.name;
  return mesh;
}

TEST(Join, NodesAndTetsByFileThenByTag)
{
  for (const bool quadratic : {false, true}) {
    const mesh::Mesh a = named("a", quadratic, 0.0), b = named("b", quadratic, 0.02);
    const mesh::Mesh all = mesh::joined({a, b});
    ASSERT_EQ(all.node_count(), a.node_count() + b.node_count());
    ASSERT_EQ(all.tet_count(), 2 * a.tet_count());
    EXPECT_EQ(all.volumes, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(all.file_of, (std::vector<std::string>{"a.msh", "b.msh"}));
    EXPECT_EQ(all.file, "a.msh,b.msh");
    EXPECT_EQ(all.remarks.back(), "b.msh: small");
    EXPECT_EQ(all.region.front(), 0);
    EXPECT_EQ(all.region.back(), 1);
    EXPECT_EQ(all.node_tag[static_cast<std::size_t>(a.node_count())], b.node_tag.front());
    for (int node : mesh::group_nodes(all, "b_z0"))
      EXPECT_NEAR(all.x[static_cast<std::size_t>(node)].z(), 0.02, 1e-15);
    double volume = 0.0;
    for (int t = 0; t < all.tet_count(); ++t) volume += mesh::tet_volume(all, t);
    EXPECT_NEAR(volume, 2e-6, 1e-18);
    EXPECT_NE(all.hash, mesh::joined({b, a}).hash);
    mesh::validate(all);
  }
}

TEST(Join, WhatDoesNotGoTogetherIsRefused)
{
  const mesh::Mesh a = named("a", false, 0.0);
  EXPECT_THROW(mesh::joined({a, named("b", true, 0.02)}), core::Failure);
  mesh::Mesh b = named("b", false, 0.02);
  b.surfaces.back().name = "a";  // a volume of the other
  try {
    mesh::joined({a, b});
    FAIL();
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    EXPECT_NE(std::string(failure.what()).find("b.msh: 'a' is a group of a.msh"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace trocar
