#include <gtest/gtest.h>

#include <cmath>

#include "support/body.hpp"

namespace trocar {
namespace {

using core::Vec3;

// Backward Euler of a body in free fall, and of one damped by αM alone, node for node, from
// wherever it is linearised.
TEST(Dynamics, FreeFallAndRayleighDecayAreBackwardEulers)
{
  for (tissue::Mass mass : {tissue::Mass::consistent, tissue::Mass::lumped}) {
    tissue::TissueSettings settings;
    settings.mass = mass;
    settings.materials = {{4000.0, 0.3, 1000.0, 3.0, 0.0}};
    settings.boundary.gravity = Vec3(0, 0, -9.81);
    test::Body body({2, 2, 2, Vec3(0.1, 0.1, 0.1), 0.2}, settings);
    tissue::TissueState state = tissue::at_rest(body.space);
    const double h = 0.01;
    double v = 0.0, z = 0.0;
    for (int n = 1; n <= 5; ++n) {
      auto motion = body.tissue.linearise(state, state.u, {n * h, h, false});
      const fem::OwnedField u = motion->alone();
      auto again = body.tissue.linearise(state, u, {n * h, h, false});
      EXPECT_LT(body.space.norm({again->alone().value - u.value}), 1e-12);
      state.v.value = (u.value - state.u.value) / h;
      state.u = u;
      v = (v - 9.81 * h) / (1.0 + 3.0 * h);
      z += h * v;
    }
    for (int i = 0; i < body.space.owned(); ++i) {
      EXPECT_NEAR(state.u.node(i).z(), z, 1e-11);
      EXPECT_NEAR(state.u.node(i).x(), 0.0, 1e-11);
    }
  }
}

// A body that glides as a whole at v: ½ m v², and damping by its mass takes α m v² a second.
TEST(Dynamics, DampingByMassTakesTheEnergyOfMotion)
{
  tissue::TissueSettings settings;
  settings.materials = {{4000.0, 0.3, 1000.0, 3.0, 0.0}};
  test::Body body({2, 2, 2, Vec3(0.1, 0.1, 0.1), 0.2}, settings);
  const double h = 0.01, mass = 1.0, square = 0.09 + 0.04 + 0.25;
  const tissue::TissueState old = tissue::at_rest(body.space);
  tissue::TissueState next = old;
  next.v = test::nodal(body, [](const Vec3&) { return Vec3(0.3, -0.2, 0.5); });
  const tissue::Work work = body.tissue.work(old, old, next, {h, h, false}, body.space.zero());
  EXPECT_NEAR(work.kinetic, 0.5 * mass * square, 1e-12);
  EXPECT_NEAR(work.damped, h * 3.0 * mass * square, 1e-12);
  EXPECT_NEAR(work.elastic, 0.0, 1e-12);
}

TEST(Dynamics, PrescribedMotionIsFollowedAndPushesItsNeighbours)
{
  tissue::TissueSettings settings;
  settings.boundary.fixed = {{"z0", 7}};
  settings.boundary.displacements = {{"z1", Vec3(0.004, std::nan(""), -0.002),
                                      core::parse_csv("time,factor\n0,0\n1,1\n", "ramp.csv")}};
  test::Body body({3, 3, 3, Vec3(0.1, 0.1, 0.1), 0.2}, settings);
  tissue::TissueState state = tissue::at_rest(body.space);
  for (int n = 1; n <= 4; ++n) {
    auto motion = body.tissue.linearise(state, state.u, {0.1 * n, 0.1, false});
    const fem::OwnedField u = motion->alone();
    state.v.value = (u.value - state.u.value) / 0.1;
    state.u = u;
  }
  const auto u = body.space.gather(state.u);
  for (int node : mesh::group_nodes(body.mesh, "z1")) {
    EXPECT_NEAR(u.node(node).x(), 0.0016, 1e-15);
    EXPECT_NEAR(u.node(node).z(), -0.0008, 1e-15);
  }
  double largest = 0.0;
  for (int node = 0; node < body.mesh.node_count(); ++node)
    if (body.mesh.x[static_cast<std::size_t>(node)].z() < 0.05 + 1e-9)
      largest = std::max(largest, u.node(node).norm());
  EXPECT_GT(largest, 1e-4);
}

}  // namespace
}  // namespace trocar
