#include <gtest/gtest.h>

#include <cmath>

#include "contact/clip.hpp"
#include "contact/face.hpp"

// The geometry of faces, by closed forms and differences.
namespace trocar::contact {
namespace {

FacePlaces curved()
{
  FacePlaces face{6, {Vec3(0, 0, 0), Vec3(1, 0, 0.1), Vec3(0.1, 1.2, 0), {}, {}, {}}};
  for (std::size_t k = 0; k < 3; ++k)
    face.x[3 + k] = 0.5 * (face.x[k] + face.x[(k + 1) % 3]) + Vec3(0.01, -0.02, 0.03);
  return face;
}

TEST(Face, ShapesAreOneAtTheirNodeAndSlopesAreDifferences)
{
  for (int count : {3, 6})
    for (int a = 0; a < count; ++a) {
      const FaceShape at_node = face_shape(count, node_param(static_cast<std::size_t>(a)));
      for (int b = 0; b < count; ++b) EXPECT_NEAR(at_node.value[b], a == b ? 1.0 : 0.0, 1e-15);
      const Param at(0.21, 0.33);
      EXPECT_NEAR(face_shape(count, at).value.sum(), 1.0, 1e-15);
      constexpr double h = 1e-6;
      for (int axis = 0; axis < 2; ++axis) {
        const Param step = h * Param::Unit(axis);
        const double slope =
            (face_shape(count, at + step).value[a] - face_shape(count, at - step).value[a]) /
            (2 * h);
        EXPECT_NEAR(face_shape(count, at).slope(a, axis), slope, 1e-9);
      }
    }
}

TEST(Face, IntegrationIsExactToDegreeFive)
{
  // ∫ξ^a η^b over the reference triangle = a! b! / (a+b+2)!, twice that in units of its area.
  for (int a = 0; a <= 5; ++a)
    for (int b = 0; a + b <= 5; ++b) {
      double sum = 0.0;
      for (const TrianglePoint& point : triangle_points())
        sum += point.weight * std::pow(point.at[1], a) * std::pow(point.at[2], b);
      EXPECT_NEAR(sum, 2.0 * std::tgamma(a + 1) * std::tgamma(b + 1) / std::tgamma(a + b + 3),
                  1e-15);
    }
}

TEST(Face, ProjectionMeetsTheFace)
{
  const FacePlaces face = curved();
  const Vec3 n = Vec3(0.1, -0.2, 1.0).normalized();
  for (const Param& at : {Param(0.2, 0.3), Param(0.7, 0.1), Param(0.05, 0.9)}) {
    const Vec3 x = face_point(face, at).x - 0.07 * n;
    const Projection found = project(face, x, n, Param(0.3, 0.3));
    ASSERT_TRUE(found.found);
    EXPECT_NEAR(found.t, 0.07, 1e-13);
    EXPECT_LT((found.at - at).norm(), 1e-12);
  }
}

TEST(Overlap, HasTheAreaOfThePolygonAndPlacesOnBoth)
{
  const Triangle slave{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  // The same triangle seen from the other side, moved by (d, 0): the overlap is (1 - d)² / 2.
  for (const double d : {0.0, 0.25, 0.6}) {
    const Triangle master{Vec3(d, 0, 0.1), Vec3(d, 1, 0.1), Vec3(1 + d, 0, 0.1)};
    double area = 0.0;
    for (const Overlap& piece : overlap(slave, master, 0.2)) {
      area += piece.area;
      for (int c = 0; c < 3; ++c) {
        Vec3 x = Vec3::Zero(), y = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
          x += piece.slave(static_cast<Eigen::Index>(k), c) * slave[k];
          y += piece.master(static_cast<Eigen::Index>(k), c) * master[k];
        }
        EXPECT_LT((y - x - Vec3(0, 0, 0.1)).norm(), 1e-14);
      }
    }
    EXPECT_NEAR(area, 0.5 * (1 - d) * (1 - d), 1e-14);
    EXPECT_TRUE(overlap(slave, master, 0.05).empty());
    EXPECT_TRUE(overlap(slave, {master[0], master[2], master[1]}, 0.2).empty());
  }
}

}  // namespace
}  // namespace trocar::contact
