#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/scene.hpp"

// Rigid surfaces of triangles beside the shapes that they stand for.
namespace trocar {
namespace {

using core::Vec3;

/// A box whose upper side is the plane z = 0, in two triangles each side.
std::vector<mesh::Triangle> box()
{
  std::vector<Vec3> x;
  for (int k = 0; k < 8; ++k)
    x.emplace_back((k & 1) ? 0.5 : -0.4, (k & 2) ? 0.6 : -0.3, (k & 4) ? 0.0 : -0.2);
  const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<mesh::Triangle> triangles;
  for (const auto& side : sides) {
    const auto at = [&](int k) { return x[static_cast<std::size_t>(side[k])]; };
    triangles.push_back({at(0), at(1), at(2)});
    triangles.push_back({at(0), at(2), at(3)});
  }
  return triangles;
}

/// A ball of triangles: an octahedron, each triangle cut in four `times` times.
std::vector<mesh::Triangle> ball(double radius, int times)
{
  std::vector<mesh::Triangle> now;
  for (double a : {1.0, -1.0})
    for (double b : {1.0, -1.0})
      for (double c : {1.0, -1.0}) {
        mesh::Triangle one{Vec3(a, 0, 0), Vec3(0, b, 0), Vec3(0, 0, c)};
        if (a * b * c < 0.0) std::swap(one[0], one[1]);
        now.push_back(one);
      }
  for (int k = 0; k < times; ++k) {
    std::vector<mesh::Triangle> finer;
    for (const auto& [a, b, c] : now) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    now = finer;
  }
  for (mesh::Triangle& triangle : now)
    for (Vec3& x : triangle) x *= radius;
  return now;
}

/// A block that is pressed on an obstacle, aslant.
step::Scene pressed_on(const contact::Obstacle& obstacle, bool quadratic, int cells = 5)
{
  test::BlockShape shape{cells, cells, 2, Vec3(0.04, 0.04, 0.02)};
  shape.quadratic = quadratic;
  step::Scene scene;
  scene.mesh = test::block(shape);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
  scene.tissue.boundary.displacements = {
      {"z1", Vec3(0.0004, 0.0002, -0.001), core::Csv{"", {"time", "f"}, {{0, 0}, {1, 1}}}}};
  scene.contact.obstacles = {obstacle};
  scene.contact.pairs = {{"rest", "z0", obstacle.name, 0.3}};
  scene.time.is_static = true;
  scene.time.step = 0.5;
  scene.time.end = 1.0;
  return scene;
}

contact::Obstacle of_triangles(const std::vector<mesh::Triangle>& triangles, const Vec3& origin)
{
  contact::Obstacle rigid{"rigid"};
  rigid.shape = contact::Obstacle::Shape::surface;
  rigid.origin = origin;
  rigid.skin = std::make_shared<const mesh::Skin>(mesh::skin_of(triangles, "triangles"));
  return rigid;
}

TEST(RigidSurface, ABoxIsAPlane)
{
  for (const bool quadratic : {false, true}) {
    const auto force = [&](const contact::Obstacle& obstacle) {
      return test::run(pressed_on(obstacle, quadratic)).reports.back().contact[0].force;
    };
    const Vec3 plane = force({"plane"}), rigid = force(of_triangles(box(), Vec3::Zero()));
    EXPECT_GT(plane.norm(), 0.1);
    // Distances are along the slave's normals, which faces with middle nodes tilt a little.
    EXPECT_LT((rigid - plane).norm(), (quadratic ? 2e-3 : 1e-8) * plane.norm());
  }
}

// It moves as other obstacles do.
TEST(RigidSurface, ABoxMoves)
{
  const auto force = [&](contact::Obstacle obstacle) {
    obstacle.path = core::Csv{"", {"time", "x", "y", "z"}, {{0, 0, 0, 0}, {1, -2e-4, 0, 5e-4}}};
    return test::run(pressed_on(obstacle, false)).reports.back().contact[0].force;
  };
  const Vec3 plane = force({"plane"}), rigid = force(of_triangles(box(), Vec3::Zero()));
  EXPECT_LT((rigid - plane).norm(), 1e-8 * plane.norm());
}

TEST(RigidSurface, ABallOfTrianglesIsNearlyABall)
{
  constexpr double radius = 0.06;
  const Vec3 middle(0.021, 0.019, -radius + 0.0002);
  contact::Obstacle exact{"ball"};
  exact.shape = contact::Obstacle::Shape::sphere;
  exact.origin = middle;
  exact.radius = radius;
  const auto force = [](const contact::Obstacle& obstacle) {
    return test::run(pressed_on(obstacle, false, 12)).reports.back().contact[0].force;
  };
  const Vec3 expected = force(exact);
  std::vector<double> error;
  for (const int times : {2, 3, 4}) {
    const Vec3 found = force(of_triangles(ball(radius, times), middle));
    error.push_back((found - expected).norm() / expected.norm());
  }
  EXPECT_LT(error[1], error[0]);
  EXPECT_LT(error[2], 0.4 * error[1]);  // the faces lie inside the ball by their edge squared
  EXPECT_LT(error[2], 0.15);
}

}  // namespace
}  // namespace trocar
