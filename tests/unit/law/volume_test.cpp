#include "law/volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "support/shell.hpp"

namespace trocar {
namespace {

using core::MatX;
using core::Vec3;
using core::VecX;

/// The unit sphere's triangles, their nodes moved about; with quadratic faces the middles of edges
/// are nodes as well.
struct Ball
{
  law::ClosedSurface surface;
  VecX x;
};

Ball ball(int levels, bool quadratic, double jitter = 0.05)
{
  test::SphereSurface sphere = test::sphere_surface(levels);
  std::vector<Vec3>& p = sphere.point;
  Ball result;
  std::map<std::pair<int, int>, int> known;
  result.surface.face_nodes = quadratic ? 6 : 3;
  for (const mesh::Face& f : sphere.face) {
    result.surface.nodes.insert(result.surface.nodes.end(), f.begin(), f.end());
    for (std::size_t k = 0; quadratic && k < 3; ++k) {
      const int i = f[k], j = f[(k + 1) % 3];
      const auto [at, fresh] = known.emplace(std::minmax(i, j), static_cast<int>(p.size()));
      if (fresh)
        p.push_back((p[static_cast<std::size_t>(i)] + p[static_cast<std::size_t>(j)]).normalized());
      result.surface.nodes.push_back(at->second);
    }
  }
  result.x.resize(3 * static_cast<Eigen::Index>(p.size()));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  for (std::size_t i = 0; i < p.size(); ++i)
    result.x.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        p[i] + Vec3(shift(random), shift(random), shift(random));
  return result;
}

VecX random_like(const VecX& x, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  VecX d(x.size());
  for (double& value : d) value = normal(random);
  return d;
}

VecX repeated(const Vec3& v, const VecX& x)
{
  return v.replicate(x.size() / 3, 1);
}

class Surfaces : public ::testing::TestWithParam<bool>
{
};

// Cavity facts of docs/theory.md section 9, on flat and on quadratic faces.
TEST_P(Surfaces, VolumeIdentities)
{
  const auto [surface, x] = ball(2, GetParam());
  const double V = law::volume(surface, x);
  const VecX g = law::volume_gradient(surface, x);
  const VecX d = random_like(x, 1), e = random_like(x, 2);
  const VecX Hd = law::volume_hessian_times(surface, x, d);
  const VecX He = law::volume_hessian_times(surface, x, e);
  EXPECT_NEAR(g.dot(x), 3.0 * V, 1e-13 * V);
  EXPECT_LT((law::volume_hessian_times(surface, x, x) - 2.0 * g).norm(), 1e-13 * g.norm());
  EXPECT_NEAR(e.dot(Hd), d.dot(He), 1e-13 * Hd.norm() * e.norm());
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (Eigen::Index i = 0; i < x.size(); i += 3) {
    sum += g.segment<3>(i);
    torque += Vec3(x.segment<3>(i)).cross(Vec3(g.segment<3>(i)));
  }
  EXPECT_LT(sum.norm(), 1e-13);
  EXPECT_LT(torque.norm(), 1e-13);
  EXPECT_NEAR(law::volume(surface, 2.0 * x), 8.0 * V, 1e-12 * V);  // a cubic
  EXPECT_LT((law::volume_gradient(surface, 2.0 * x) - 4.0 * g).norm(), 1e-13 * g.norm());
  // Rigid motion.
  const core::Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  VecX moved = x;
  for (Eigen::Index i = 0; i < x.size(); i += 3)
    moved.segment<3>(i) = R * x.segment<3>(i) + Vec3(0.3, -0.2, 0.5);
  EXPECT_NEAR(law::volume(surface, moved), V, 1e-13 * V);
}

TEST_P(Surfaces, DerivativesAgreeWithDifferences)
{
  const auto [surface, x] = ball(1, GetParam());
  const VecX d = random_like(x, 3);
  const Vec3 phi(0.3, -1.0, 2.0);
  const double h = 1e-3;
  // V is a cubic and Q a quartic: differences of fourth order are exact but for round-off.
  const auto slope = [&](const auto& f) {
    return ((8.0 * (f(x + h * d) - f(x - h * d)) - (f(x + 2 * h * d) - f(x - 2 * h * d))) /
            (12.0 * h));
  };
  EXPECT_NEAR(slope([&](const VecX& y) { return law::volume(surface, y); }),
              law::volume_gradient(surface, x).dot(d), 1e-10);
  EXPECT_NEAR(slope([&](const VecX& y) { return law::moment(surface, y, phi); }),
              law::moment_gradient(surface, x, phi).dot(d), 1e-10);
  const VecX H =
      (law::volume_gradient(surface, x + h * d) - law::volume_gradient(surface, x - h * d)) /
      (2.0 * h);
  EXPECT_LT((H - law::volume_hessian_times(surface, x, d)).norm(), 1e-10 * H.norm());
  const VecX M = law::moment_hessian_times(surface, x, phi, d);
  const VecX e = random_like(x, 4);
  EXPECT_NEAR(e.dot(M), d.dot(law::moment_hessian_times(surface, x, phi, e)),
              1e-12 * M.norm() * e.norm());
  const auto slope_of_gradient = [&](const VecX& y) -> VecX {
    return law::moment_gradient(surface, y, phi);
  };
  const VecX M_h = (8.0 * (slope_of_gradient(x + h * d) - slope_of_gradient(x - h * d)) -
                    (slope_of_gradient(x + 2 * h * d) - slope_of_gradient(x - 2 * h * d))) /
                   (12.0 * h);
  EXPECT_LT((M_h - M).norm(), 1e-10 * M.norm());
}

// The whole force of a pressure φ·x is φ V (Archimedes), its work under a shift likewise.
TEST_P(Surfaces, Archimedes)
{
  const auto [surface, x] = ball(2, GetParam());
  const Vec3 phi(0.0, 0.0, -9810.0);
  const VecX f = law::moment_gradient(surface, x, phi);
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < x.size(); i += 3) sum += f.segment<3>(i);
  EXPECT_LT((sum - phi * law::volume(surface, x)).norm(), 1e-13 * sum.norm());
  const Vec3 shift(0.1, 0.2, -0.3);
  EXPECT_NEAR(law::moment(surface, x + repeated(shift, x), phi),
              law::moment(surface, x, phi) + phi.dot(shift) * law::volume(surface, x), 1e-11);
}

// A volume 3 m away from where its coordinates count from keeps its digits only when they are taken
// from a point near it: what cavity walls do.
TEST_P(Surfaces, CubicAlongDisplacements)
{
  const auto [surface, x] = ball(2, GetParam());
  MatX y(x.size(), 3);
  y << x, 0.1 * random_like(x, 5), 0.1 * random_like(x, 6);
  const law::VolumeCubic cubic(surface, y);
  const VecX p = Eigen::Vector2d(0.7, -1.3);
  const VecX at = y.col(0) + y.rightCols(2) * p;
  const double V = law::volume(surface, at);
  EXPECT_NEAR(cubic.value(p), V, 1e-13 * std::abs(V));
  const VecX slope = y.rightCols(2).transpose() * law::volume_gradient(surface, at);
  EXPECT_LT((cubic.gradient(p) - slope).norm(), 1e-12 * slope.norm());
}

INSTANTIATE_TEST_SUITE_P(FlatAndQuadratic, Surfaces, ::testing::Values(false, true));

// Quadratic faces through the sphere's points enclose its volume to fourth order.
TEST(QuadraticSurface, SphereConverges)
{
  double last = 0.0;
  for (int levels : {1, 2, 3}) {
    const auto [surface, x] = ball(levels, true, 0.0);
    const double error = std::abs(law::volume(surface, x) - 4.0 * std::numbers::pi / 3.0);
    if (levels > 1) {
      EXPECT_GT(std::log2(last / error), 3.7);
    }
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

}  // namespace
}  // namespace trocar
