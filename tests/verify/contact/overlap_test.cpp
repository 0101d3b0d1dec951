#include <gtest/gtest.h>

#include <cmath>

#include "core/failure.hpp"
#include "support/bodies.hpp"
#include "support/scene.hpp"

// Bodies that overlap as they are given.
namespace trocar {
namespace {

using core::Vec3;

constexpr double high = 0.02;

/// A block that is held, and a smaller one that sinks into it by `depth`, held at its upper end;
/// the surface between is bent, so that the overlap differs from corner to corner.
step::Scene overlapping(double depth, bool quadratic, double friction = 0.0)
{
  test::BlockShape lower{4, 4, 2, Vec3(0.04, 0.04, high)}, upper{3, 3, 2, Vec3(0.03, 0.03, high)};
  lower.quadratic = upper.quadratic = quadratic;
  upper.map = [=](const Vec3& X) {
    const double bent = 0.3 * depth * std::sin(100.0 * X.x());
    return Vec3(X + Vec3(0.005, 0.005, high - depth + bent));
  };
  step::Scene scene;
  scene.mesh = test::joined(test::block(lower), test::block(upper));
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials.assign(2, {5000.0, 0.3, 1000.0, 0.0, 0.0});
  scene.tissue.boundary.fixed = {{"a_z0", 7}, {"b_z1", 7}};
  scene.contact.pairs = {{"faces", "b_z0", "a_z1", friction}};
  scene.time.is_static = true;
  return scene;
}

double moved(const test::Run& run)
{
  double most = 0.0;
  for (const step::State& state : run.states)
    if (state.tissue.u.value.size() > 0)
      most = std::max(most, state.tissue.u.value.cwiseAbs().maxCoeff());
  return base::Comm(MPI_COMM_WORLD).max(most);
}

TEST(Overlap, IsAClosedGapWithoutForce)
{
  for (const bool quadratic : {false, true})
    for (const double friction : {0.0, 0.4}) {
      step::Scene scene = overlapping(0.001, quadratic, friction);
      const test::Run closed = test::run(scene);
      EXPECT_LT(moved(closed), 1e-12);
      EXPECT_LT(closed.reports[0].contact[0].force.norm(), 1e-9);
      EXPECT_FALSE(closed.states[0].contact.pairs[0].overlapped.empty());
      scene.contact.pairs[0].closed = false;
      EXPECT_GT(moved(test::run(scene)), 2e-4);
    }
}

// It stays closed: the force of pressing on is that of bodies which just touch.
TEST(Overlap, IsKeptAsTheBodiesMoveOn)
{
  const auto pressed = [](double depth) {
    step::Scene scene = overlapping(depth, false);
    scene.tissue.boundary.fixed.pop_back();
    scene.tissue.boundary.displacements = {
        {"b_z1", Vec3(0, 0, -0.0005), core::Csv{"", {"time", "f"}, {{0, 0}, {1, 1}}}}};
    scene.time.step = 0.5;
    scene.time.end = 1.0;
    const test::Run run = test::run(scene);
    EXPECT_GE(run.reports.back().contact[0].weighted_gap, -1e-8);
    return -run.reports.back().contact[0].force.z();
  };
  const double touching = pressed(1e-9);
  EXPECT_GT(touching, 0.01);
  EXPECT_NEAR(pressed(0.0005), touching, 0.03 * touching);
}

TEST(Overlap, BeyondTheSearchIsRefused)
{
  step::Scene scene = overlapping(0.012, false);
  scene.contact.pairs[0].search = 0.005;
  try {
    test::run(scene);
    FAIL();
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    EXPECT_NE(std::string(failure.what()).find("overlap by 0.0"), std::string::npos)
        << failure.what();
  }
}

// The far sides of thin bodies are no overlap: two plates apart, each with its whole skin in the
// pair, and the search distance larger than a plate is thick.
TEST(Overlap, FarSidesOfThinBodiesAreNone)
{
  test::BlockShape below{6, 6, 1, Vec3(0.03, 0.03, 0.004)}, above = below;
  above.map = [](const Vec3& X) { return Vec3(X + Vec3(0.001, 0.002, 0.0045)); };
  step::Scene scene;
  scene.mesh = test::joined(test::block(below), test::block(above));
  for (const std::string body : {"a_", "b_"}) {
    mesh::SurfaceGroup skin{body + "skin", {}};
    for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
      for (const mesh::Face& face : mesh::surface_group(scene.mesh, body + side).faces)
        skin.faces.push_back(face);
    scene.mesh.surfaces.push_back(skin);
  }
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials.assign(2, {5000.0, 0.3, 1000.0, 0.0, 0.0});
  scene.tissue.boundary.fixed = {{"a_z0", 7}, {"b_z1", 7}};
  scene.contact.pairs = {{"skins", "b_skin", "a_skin"}};
  scene.contact.pairs[0].search = 0.006;
  scene.time.is_static = true;
  const test::Run run = test::run(scene);
  EXPECT_TRUE(run.states[0].contact.pairs[0].overlapped.empty());
  EXPECT_LT(moved(run), 1e-12);
  EXPECT_EQ(run.reports[0].contact[0].slipping, 0);
}

}  // namespace
}  // namespace trocar
