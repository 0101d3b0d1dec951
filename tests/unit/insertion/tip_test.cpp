#include "insertion/tip.hpp"

#include <gtest/gtest.h>

#include "insertion/membranes.hpp"
#include "mesh/topology.hpp"
#include "support/block.hpp"

namespace trocar::insertion {
namespace {

/// Σ weight (X - middle)(X - middle)ᵀ of an anchor: what quadratic tets see exactly.
core::Mat3 spread(const mesh::Mesh& mesh, const constraint::Anchor& anchor, const Vec3& middle)
{
  core::Mat3 sum = core::Mat3::Zero();
  for (std::size_t a = 0; a < anchor.node.size(); ++a) {
    const Vec3 arm = mesh.x[static_cast<std::size_t>(anchor.node[a])] - middle;
    sum += anchor.weight[static_cast<Eigen::Index>(a)] * arm * arm.transpose();
  }
  return sum;
}

// Hertz's pressure on a disc of radius R has the second moment R²/5 along every diameter, a uniform
// ball has it along every axis; samples, the middle one among them, are off by some percent.
TEST(TipSupport, SpreadsAsHertzAndTheUniformBallDo)
{
  test::BlockShape shape{4, 4, 4, Vec3(0.04, 0.04, 0.04), 0.0};
  shape.quadratic = true;
  const mesh::Mesh mesh = test::block(shape);
  const mesh::Locator locator(mesh);
  const double R = 0.011;
  const Vec3 top(0.0193, 0.0211, 0.04), inside(0.0193, 0.0211, 0.0197);
  const core::Mat3 frame = core::frame_along(Vec3::UnitZ());
  const constraint::Anchor disc =
      tip_support(mesh, locator, {top, locator.tet_at(top), R}, frame, true);
  const core::Mat3 flat = Vec3(0.2, 0.2, 0.0).asDiagonal();
  EXPECT_NEAR(disc.weight.sum(), 1.0, 1e-12);
  EXPECT_LT((spread(mesh, disc, top) / (R * R) - flat).norm(), 0.012);
  const constraint::Anchor ball =
      tip_support(mesh, locator, {inside, locator.tet_at(inside), R}, frame, false);
  const core::Mat3 round = Vec3(0.2, 0.2, 0.2).asDiagonal();
  EXPECT_LT((spread(mesh, ball, inside) / (R * R) - round).norm(), 0.015);
}

// A face that is part of two surfaces holds as well as the stronger of them.
TEST(Membranes, OfTwoSurfacesTheStrongerHolds)
{
  mesh::Mesh mesh = test::block({2, 2, 2, Vec3(0.02, 0.02, 0.02), 0.0});
  mesh.surfaces.push_back(mesh.surfaces.front());  // x0 once more
  mesh.surfaces.back().name = "capsule";
  const mesh::Locator locator(mesh);
  const Vec3 X(0.0, 0.0113, 0.0071);
  const int tet = locator.tet_at(X);
  for (const auto& [first, last] : {std::pair{0.3, 0.8}, {0.8, 0.3}}) {
    PunctureSettings settings{{0.1}, std::vector<double>(mesh.surfaces.size(), -1.0)};
    settings.surface.front() = first;
    settings.surface.back() = last;
    const Membranes membranes(mesh, settings);
    EXPECT_EQ(membranes.threshold(-1, tet, X), 0.8);
    EXPECT_EQ(membranes.threshold(-1, locator.tet_at(Vec3(0.02, 0.0113, 0.0071)),
                                  Vec3(0.02, 0.0113, 0.0071)),
              0.1);  // as the volume says
  }
}

}  // namespace
}  // namespace trocar::insertion
