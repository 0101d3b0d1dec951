#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/failure.hpp"
#include "law/volume.hpp"
#include "mesh/quadratic.hpp"
#include "support/shell.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// A tet of some shape with its middles in the middle.
mesh::TetPositions straight_tet()
{
  mesh::TetPositions x(3, 10);
  x.leftCols<4>() << 0.1, 1.1, 0.2, 0.0, 0.0, 0.2, 0.9, 0.1, -0.1, 0.0, 0.1, 1.2;
  for (std::size_t k = 0; k < 6; ++k)
    x.col(static_cast<Eigen::Index>(4 + k)) =
        0.5 * (x.col(static_cast<Eigen::Index>(mesh::tet_edges[k][0])) +
               x.col(static_cast<Eigen::Index>(mesh::tet_edges[k][1])));
  return x;
}

/// Volume between its four faces as they are curved, by the divergence theorem.
double between_faces(const mesh::TetPositions& x)
{
  law::ClosedSurface surface;
  surface.face_nodes = 6;
  surface.nodes = {0, 2, 1, 6, 5, 4, 0, 1, 3, 4, 8, 7, 0, 3, 2, 7, 9, 6, 1, 2, 3, 5, 9, 8};
  return law::volume(surface, core::VecX(x.reshaped()));
}

TEST(Volume, OfOneMovedMiddle)
{
  // The unit tet with the middle of edge 01 moved by d: V = (1 - d_y - d_z)/6.
  mesh::TetPositions x(3, 10);
  x << 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0,  //
      0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5,   //
      0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0.5;
  EXPECT_DOUBLE_EQ(mesh::curved_volume(x), 1.0 / 6.0);
  x.col(4) += Vec3(0.02, -0.05, -0.08);
  EXPECT_NEAR(mesh::curved_volume(x), 1.13 / 6.0, 1e-15);
}

// All middles moved: the Jacobian is a full cubic.
TEST(Volume, OfACurvedTetIsWhatItsFacesEnclose)
{
  mesh::TetPositions x = straight_tet();
  const double straight = mesh::curved_volume(x);
  EXPECT_NEAR(straight, between_faces(x), 1e-15);
  for (Eigen::Index k = 0; k < 6; ++k)
    for (Eigen::Index i = 0; i < 3; ++i)
      x(i, 4 + k) += 0.08 * std::sin(1.0 + 2.3 * static_cast<double>(k + 7 * i));
  EXPECT_NEAR(mesh::curved_volume(x), between_faces(x), 1e-15);
  EXPECT_GT(std::abs(mesh::curved_volume(x) - straight), 0.005 * straight);
}

TEST(Volume, OfARoundMeshIsThatOfTheShell)
{
  mesh::Mesh mesh = test::shell(2, 2, 0.5, 1.0);
  const double exact = 4.0 / 3.0 * std::numbers::pi * (1.0 - 0.125);
  const mesh::Quality polyhedron = mesh::quality(mesh);
  EXPECT_LT(polyhedron.volume, 0.95 * exact);
  mesh::make_quadratic(mesh);
  EXPECT_NEAR(mesh::quality(mesh).volume, polyhedron.volume, 1e-14);
  test::make_round(mesh);
  const mesh::Quality round = mesh::quality(mesh);
  EXPECT_NEAR(round.volume, exact, 2e-3 * exact);
  EXPECT_EQ(round.mean, polyhedron.mean);  // quality is that of the corners
  double sum = 0.0;
  for (int t = 0; t < mesh.tet_count(); ++t) sum += mesh::tet_volume(mesh, t);
  EXPECT_NEAR(sum, round.volume, 1e-13);
}

TEST(Volume, AFoldedTetNamesWhatMendsIt)
{
  mesh::Mesh mesh = test::shell(1, 1, 0.5, 1.0);
  mesh::make_quadratic(mesh);
  mesh.x[static_cast<std::size_t>(mesh.middles[0][3])] *= 3.0;
  try {
    mesh::validate(mesh);
    ADD_FAILURE() << "accepted a folded tet";
  } catch (const core::Failure& failure) {
    const std::string line = failure.what();
    EXPECT_NE(line.find("folded by its curved edges"), std::string::npos) << line;
    EXPECT_NE(line.find("gmsh -optimize_ho"), std::string::npos) << line;
    EXPECT_NE(line.find("Mesh.HighOrderOptimize"), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace trocar
