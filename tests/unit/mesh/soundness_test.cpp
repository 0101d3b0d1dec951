#include <gtest/gtest.h>

#include <cmath>

#include "core/failure.hpp"
#include "mesh/soundness.hpp"
#include "support/block.hpp"

namespace trocar::mesh {
namespace {

/// Tets of given corners, tagged from 101 on, nodes from 1 on.
Mesh mesh_of(std::vector<Vec3> x, std::vector<Tet> tets)
{
  Mesh mesh;
  mesh.file = "some.msh";
  mesh.volumes = {"body"};
  for (std::size_t i = 0; i < x.size(); ++i) mesh.node_tag.push_back(static_cast<long long>(i) + 1);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    mesh.elem_tag.push_back(static_cast<long long>(t) + 101);
    mesh.region.push_back(0);
  }
  mesh.x = std::move(x);
  mesh.tets = std::move(tets);
  return mesh;
}

std::string refusal(Mesh mesh)
{
  try {
    drop_repeated(mesh);
    validate(mesh);
    judge(mesh);
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    return failure.what();
  }
  return "accepted";
}

std::vector<std::string> remarks(Mesh mesh)
{
  drop_repeated(mesh);
  judge(mesh);
  return mesh.remarks;
}

const std::vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::vector<Vec3> with(std::vector<Vec3> x, const std::vector<Vec3>& more)
{
  x.insert(x.end(), more.begin(), more.end());
  return x;
}

TEST(Soundness, ABlockIsSound)
{
  EXPECT_EQ(remarks(test::block({4, 3, 2, Vec3(0.4, 0.3, 0.2), 0.2})), std::vector<std::string>());
  const auto bent = [](const Vec3& x) { return Vec3(x + Vec3(0, 0, 0.4 * x[0] * x[0])); };
  EXPECT_EQ(remarks(test::block(
                {3, 3, 3, Vec3::Ones(), 0.2, [](const Vec3&) { return false; }, true, bent})),
            std::vector<std::string>());
}

TEST(Soundness, ThreeTetsOnAFaceAreRefused)
{
  EXPECT_EQ(refusal(mesh_of(with(corner, {{0, 0, -1}, {0.1, 0, -2}}),
                            {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 2, 1, 5}})),
            "some.msh: tetrahedra 101, 102, 103 have one face in common (nodes 1, 2, 3)");
}

TEST(Soundness, TetsOnOneSideOfAFaceAreRefused)
{
  EXPECT_EQ(
      refusal(mesh_of(with(corner, {{0.1, 0.1, 2}}), {{0, 1, 2, 3}, {0, 1, 2, 4}})),
      "some.msh: tetrahedra 101, 102 are on the same side of the face they share (nodes 1, 2, "
      "3)");
}

// Three tets around the edge z would take one full turn with 120 degrees each; here they take more.
TEST(Soundness, TetsThatOverlapAroundACommonEdgeAreRefused)
{
  std::vector<Vec3> x{{0, 0, 0}, {0, 0, 1}};
  std::vector<Tet> tets;
  for (int k = 0; k < 5; ++k) {  // 4 tets of 100 degrees
    const double angle = 100.0 * k * 3.141592653589793 / 180.0;
    x.push_back({std::cos(angle), std::sin(angle), 0});
    if (k > 0) tets.push_back({0, k + 1, k + 2, 1});
  }
  EXPECT_EQ(refusal(mesh_of(x, tets)),
            "some.msh: tetrahedra 101 and 104 of one connected part overlap");
}

TEST(Soundness, OverlapIsRefusedInOnePartAndSaidOfTwo)
{
  const std::vector<Vec3> moved{{0.2, 0.1, 0.1}, {1.2, 0.1, 0.1}, {0.2, 1.1, 0.1}, {0.2, 0.1, 1.1}};
  const auto said = remarks(mesh_of(with(corner, moved), {{0, 1, 2, 3}, {4, 5, 6, 7}}));
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[0], "the mesh has 2 separate parts");
  // The second is below the first one's slanted face by (1 - 0.4)/sqrt(3).
  EXPECT_EQ(
      said[1],
      "separate parts overlap: 1 pair of tetrahedra at their boundaries, by 0.34641 m at most");
  // Joined by a node, which is connection enough to be one part.
  EXPECT_EQ(
      refusal(mesh_of(with(corner, {moved[0], moved[1], moved[2]}), {{0, 1, 2, 3}, {4, 5, 6, 3}})),
      "some.msh: tetrahedra 101 and 102 of one connected part overlap");
}

TEST(Soundness, APartWhollyInsideAnotherIsSaid)
{
  std::vector<Vec3> x = corner;
  for (const Vec3& p : corner) x.push_back(0.1 * p + Vec3::Constant(0.05));
  const auto said = remarks(mesh_of(x, {{0, 1, 2, 3}, {4, 5, 6, 7}}));
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back(), "1 separate part begins inside tetrahedra of another one");
}

TEST(Soundness, UngluedNodesAreCounted)
{
  const auto said = remarks(mesh_of(with(corner, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}),
                                    {{0, 1, 2, 3}, {4, 6, 5, 7}}));
  EXPECT_EQ(said, (std::vector<std::string>{
                      "3 nodes lie where another one does (the first: 1 and 5): the tissue is not "
                      "glued together there",
                      "the mesh has 2 separate parts"}));
}

TEST(Soundness, EdgesWhereTheBoundaryMeetsItselfAreCounted)
{
  const auto said =
      remarks(mesh_of(with(corner, {{0, -1, 0}, {0, 0, -1}}), {{0, 1, 2, 3}, {0, 1, 4, 5}}));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].rfind("the boundary meets itself along 1 edge (the first: nodes 1, 2)", 0), 0U)
      << said[0];
}

TEST(Soundness, WhatIsListedTwiceCountsOnce)
{
  Mesh mesh = mesh_of(corner, {{0, 1, 2, 3}, {1, 2, 0, 3}});
  mesh.surfaces.push_back({"low", {{0, 1, 2}, {2, 1, 0}}, {7, 8}, {}});
  drop_repeated(mesh);
  judge(mesh);
  EXPECT_EQ(mesh.tet_count(), 1);
  EXPECT_EQ(mesh.elem_tag, std::vector<long long>{101});
  EXPECT_EQ(mesh.surfaces[0].faces, (std::vector<Face>{{0, 1, 2}}));
  EXPECT_EQ(mesh.remarks, (std::vector<std::string>{
                              "1 tetrahedron is listed again: each counts once",
                              "surface 'low': 1 triangle is listed again: each counts once"}));
  mesh = mesh_of(corner, {{0, 1, 2, 3}, {1, 2, 0, 3}});
  mesh.volumes.push_back("other");
  mesh.region[1] = 1;
  EXPECT_EQ(refusal(mesh),
            "some.msh: tetrahedra 101 and 102 are the same one in two physical volumes, 'body' and "
            "'other'");
}

TEST(Soundness, TrianglesThatAreNoFaceMakeASurfaceUseless)
{
  Mesh mesh = mesh_of(with(corner, {{1, 1, 1}}), {{0, 1, 2, 3}, {1, 2, 3, 4}});
  mesh.surfaces.push_back({"skin", {{0, 1, 2}, {0, 1, 4}}, {7, 8}, {}});
  mesh.surfaces.push_back({"between", {{1, 3, 2}}, {9}, {}});
  judge(mesh);
  EXPECT_EQ(surface_group(mesh, "between").faces.size(), 1U);
  try {
    surface_group(mesh, "skin");
    ADD_FAILURE();
  } catch (const core::Failure& failure) {
    EXPECT_STREQ(failure.what(),
                 "some.msh: surface 'skin' has 1 triangles that are no face of a tetrahedron: 8");
  }
}

TEST(OverlapDepth, IsTheShortestWayApart)
{
  const std::array<Vec3, 4> a{corner[0], corner[1], corner[2], corner[3]};
  const auto moved = [&](const Vec3& by) {
    std::array<Vec3, 4> b = a;
    for (Vec3& x : b) x += by;
    return b;
  };
  EXPECT_NEAR(overlap_depth(a, moved({0.9, 0, 0})), 0.1 / std::sqrt(3.0), 1e-15);
  EXPECT_EQ(overlap_depth(a, moved({1.0, 0, 0})), 0.0);
  EXPECT_EQ(overlap_depth(a, moved({0.5, 0.6, 0})), 0.0);
  // Two edges that cross, where no face separates.
  const std::array<Vec3, 4> across{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 2), Vec3(0, -1, 2)};
  std::array<Vec3, 4> below{Vec3(0, -1, 0), Vec3(1, 0, -2), Vec3(0, 1, 0), Vec3(-1, 0, -2)};
  EXPECT_EQ(overlap_depth(across, below), 0.0);
  for (Vec3& x : below) x.z() += 0.25;
  EXPECT_NEAR(overlap_depth(across, below), 0.25, 1e-15);
}

}  // namespace
}  // namespace trocar::mesh
