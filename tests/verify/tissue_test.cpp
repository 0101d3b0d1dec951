#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/body.hpp"

namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;

tissue::TissueSettings all_faces_held(tissue::Model model)
{
  tissue::TissueSettings settings;
  settings.model = model;
  settings.materials = {{4000.0, 0.3, 1000.0, 0.0, 0.0}};
  for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
    settings.boundary.fixed.push_back({side, 7});
  return settings;
}

using test::nodal;

const core::TimeStep at_rest{0.0, 1.0, true};

// A linear displacement on the boundary goes on linearly inside, on distorted tets.
TEST(Patch, ConstantStrainIsReproduced)
{
  for (tissue::Model model : {tissue::Model::linear, tissue::Model::corotational}) {
    test::Body body({4, 4, 4, Vec3(1.0, 0.9, 1.1), 0.25}, all_faces_held(model));
    Mat3 G;
    G << 0.01, 0.02, -0.005, 0.0, -0.015, 0.01, 0.004, 0.0, 0.02;
    const auto exact = nodal(body, [&](const Vec3& X) { return Vec3(G * X); });
    // Inside: anything; the boundary as prescribed (its increments are then zero).
    fem::OwnedField u = exact;
    for (int i = 0; i < body.space.owned(); ++i)
      if (body.tissue.fixed().axes_of_number(body.space.first() + i) == 0)
        u.node(i) += Vec3(0.001, -0.002, 0.0015);
    // The prescribed displacement of the held faces is zero: move the target by hand.
    tissue::TissueState old{exact, body.space.zero()};
    for (int iteration = 0; iteration < (model == tissue::Model::linear ? 1 : 30); ++iteration) {
      double scale = 0.0;
      const fem::OwnedField r = body.tissue.residual(old, u, at_rest, scale);
      if (iteration == 0) body.tissue.prepare(at_rest);
      u = body.tissue.finish({u, body.tissue.begin(r), std::nullopt}, {}, {});
    }
    EXPECT_LT(body.comm.max((u.value - exact.value).cwiseAbs().maxCoeff()),
              1e-12 * body.comm.max(exact.value.cwiseAbs().maxCoeff()) + 1e-16);
  }
}

TEST(RigidModes, CostNoForce)
{
  for (tissue::Model model : {tissue::Model::linear, tissue::Model::corotational}) {
    tissue::TissueSettings settings;
    settings.model = model;
    test::Body body({3, 3, 3, Vec3(0.1, 0.1, 0.1), 0.25}, settings);
    const tissue::TissueState old = body.tissue.at_rest();
    const auto force = [&](const fem::OwnedField& u) {
      double scale = 0.0;
      const auto r = body.tissue.residual(old, u, at_rest, scale);
      return body.comm.max(r.value.cwiseAbs().maxCoeff());
    };
    const Mat3 Q = core::rotation_exp(Vec3(1.0, -2.0, 0.5));
    const double stiff = 5000.0 * 0.1 * 0.1;  // E L u with u ~ L
    EXPECT_LT(force(nodal(body, [](const Vec3&) { return Vec3(0.1, -0.2, 0.05); })), 1e-12 * stiff);
    if (model == tissue::Model::linear)
      EXPECT_LT(force(nodal(body, [](const Vec3& X) { return Vec3(0.1, 0.3, -0.2).cross(X); })),
                1e-12 * stiff);
    else
      EXPECT_LT(force(nodal(body, [&](const Vec3& X) { return Vec3(Q * X - X); })), 1e-12 * stiff);
  }
}

// Uniaxial tension by traction: E ε = σ, lateral strain -ν ε, exact with P1.
TEST(Traction, StretchesABarByItsModulus)
{
  tissue::TissueSettings settings;
  settings.model = tissue::Model::linear;
  settings.materials = {{4000.0, 0.3, 1000.0, 0.0, 0.0}};
  settings.boundary.fixed = {{"x0", 1}, {"y0", 2}, {"z0", 4}};
  settings.boundary.tractions = {{"x1", Vec3(40.0, 0, 0), std::nullopt}};
  test::Body body({4, 2, 2, Vec3(0.2, 0.1, 0.1), 0.2}, settings);
  const tissue::TissueState old = body.tissue.at_rest();
  const auto motion = body.tissue.free_motion(old, old.u, at_rest);
  const auto exact =
      nodal(body, [](const Vec3& X) { return Vec3(0.01 * X.x(), -0.003 * X.y(), -0.003 * X.z()); });
  EXPECT_LT(
      body.comm.max((body.tissue.finish(motion, {}, {}).value - exact.value).cwiseAbs().maxCoeff()),
      1e-13);
}

// Backward Euler of a body in free fall, and of one damped by αM alone, node for node.
TEST(Dynamics, FreeFallAndRayleighDecayAreBackwardEulers)
{
  for (tissue::Mass mass : {tissue::Mass::consistent, tissue::Mass::lumped}) {
    tissue::TissueSettings settings;
    settings.mass = mass;
    settings.materials = {{4000.0, 0.3, 1000.0, 3.0, 0.0}};
    settings.boundary.gravity = Vec3(0, 0, -9.81);
    test::Body body({2, 2, 2, Vec3(0.1, 0.1, 0.1), 0.2}, settings);
    tissue::TissueState state = body.tissue.at_rest();
    const double h = 0.01;
    double v = 0.0, z = 0.0;
    for (int n = 1; n <= 5; ++n) {
      const auto motion = body.tissue.free_motion(state, state.u, {n * h, h, false});
      const fem::OwnedField u = body.tissue.finish(motion, {}, {});
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

TEST(Dynamics, PrescribedMotionIsFollowedAndPushesItsNeighbours)
{
  tissue::TissueSettings settings;
  settings.boundary.fixed = {{"z0", 7}};
  settings.boundary.displacements = {{"z1", Vec3(0.004, std::nan(""), -0.002),
                                      core::parse_csv("time,factor\n0,0\n1,1\n", "ramp.csv")}};
  test::Body body({3, 3, 3, Vec3(0.1, 0.1, 0.1), 0.2}, settings);
  tissue::TissueState state = body.tissue.at_rest();
  for (int n = 1; n <= 4; ++n) {
    const auto motion = body.tissue.free_motion(state, state.u, {0.1 * n, 0.1, false});
    const fem::OwnedField u = body.tissue.finish(motion, {}, {});
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

TEST(Supports, FloatingBodiesAreRefusedInStatics)
{
  const auto refused = [](std::vector<tissue::BoundaryConditions::Fixed> fixed) {
    tissue::TissueSettings settings;
    settings.boundary.fixed = std::move(fixed);
    test::Body body({2, 2, 2}, settings);
    try {
      tissue::require_supports(body.tissue.fixed(), body.mesh);
      return false;
    } catch (const core::Failure& failure) {
      return failure.code() == core::ExitCode::options;
    }
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({{"z0", 4}}));
  EXPECT_TRUE(refused({{"z0", 4}, {"x0", 1}}));
  EXPECT_FALSE(refused({{"z0", 4}, {"x0", 1}, {"y0", 2}}));
  EXPECT_FALSE(refused({{"z0", 7}}));
}

}  // namespace
}  // namespace trocar
