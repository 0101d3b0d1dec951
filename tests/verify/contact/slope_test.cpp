#include <gtest/gtest.h>

#include <cmath>

#include "support/scene.hpp"

// A block on a rigid slope with Coulomb's friction.
namespace trocar {
namespace {

using core::Vec3;

constexpr double friction = 0.5, g = 9.81;

/// tan(angle of the slope) = `steepness` · friction. The slope is level, gravity is turned.
step::Scene block_on_slope(double steepness, bool quadratic, int cells)
{
  test::BlockShape shape{cells, cells, 1, Vec3(0.04, 0.04, 0.02)};
  shape.quadratic = quadratic;
  step::Scene scene;
  scene.mesh = test::block(shape);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
  const double angle = std::atan(steepness * friction);
  scene.tissue.boundary.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  scene.contact.obstacles = {{"floor"}};
  scene.contact.pairs = {{"floor", "z0", "floor", friction}};
  scene.time.step = 0.02;
  return scene;
}

/// Mean velocity of all nodes.
Vec3 speed(const step::Scene& scene, const step::State& state)
{
  const base::Comm comm(MPI_COMM_WORLD);
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < state.tissue.v.value.size(); i += 3)
    sum += state.tissue.v.value.segment<3>(i);
  for (int axis = 0; axis < 3; ++axis) sum[axis] = comm.sum(sum[axis]);
  return sum / scene.mesh.node_count();
}

TEST(Slope, ABlockSlidesWithTheAccelerationOfCoulombsLaw)
{
  for (const bool quadratic : {false, true}) {
    step::Scene scene = block_on_slope(1.5, quadratic, 2);
    scene.time.end = 4.0;
    const test::Run run = test::run(scene);
    for (std::size_t n = 1; n < run.states.size(); ++n)
      for (const contact::CornerReport& corner : run.reports[n].contact[0].corners) {
        const double normal = -corner.force.z(), shear = corner.force.head<2>().norm();
        EXPECT_LE(shear, friction * normal * (1.0 + 1e-6) + 1e-9) << n;
        if (corner.state != contact::CornerReport::slips) continue;
        EXPECT_NEAR(shear, friction * normal, 1e-6 * normal + 1e-9) << n;
      }
    const std::size_t last = run.states.size() - 1;
    const double a =
        (speed(scene, run.states[last]) - speed(scene, run.states[last - 1])).x() / scene.time.step;
    const double angle = std::atan(1.5 * friction);
    const double expected = g * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(a, expected, 1e-6 * g) << quadratic;
  }
}

TEST(Slope, ABlockBelowTheLimitStays)
{
  for (const bool quadratic : {false, true}) {
    step::Scene scene = block_on_slope(0.9, quadratic, 2);
    scene.time.end = 6.0;
    const test::Run run = test::run(scene);
    const auto place = [&](std::size_t n) { return run.states[n].tissue.u.value; };
    const std::size_t last = run.states.size() - 1, before = last - 100;
    EXPECT_EQ(run.reports[last].contact[0].slipping, 0);
    EXPECT_GT(run.reports[last].contact[0].sticking, 0);
    const core::VecX moved = place(last) - place(before);
    EXPECT_LT(moved.size() > 0 ? moved.cwiseAbs().maxCoeff() : 0.0, 1e-8) << quadratic;
    // It carries its weight.
    const double weight = 1000.0 * 0.04 * 0.04 * 0.02 * g;
    EXPECT_NEAR(run.reports[last].contact[0].force.norm(), weight, 1e-6 * weight);
  }
}

// A floor that moves on drags the block with Coulomb's force until the block moves with it.
TEST(Slope, AMovingFloorDragsTheBlock)
{
  step::Scene scene = block_on_slope(0.0, false, 2);
  scene.time.start_in_equilibrium = true;
  constexpr double belt = 0.6;  // its speed [m/s], reached by the block after 0.12 s
  scene.contact.obstacles[0].path =
      core::Csv{"belt", {"time", "x", "y", "z"}, {{0, 0, 0, 0}, {1, 0, belt, 0}}};
  scene.time.step = 0.002;
  scene.time.end = 0.4;
  scene.energy = true;
  const test::Run run = test::run(scene);
  const Vec3 early = speed(scene, run.states[40]), late = speed(scene, run.states.back());
  EXPECT_NEAR(early.y(), friction * g * 0.08, 0.02 * belt);
  EXPECT_NEAR(late.y(), belt, 0.01 * belt);
  EXPECT_EQ(run.reports.back().contact[0].slipping, 0);
  // The belt pays as much for heat as for the block's motion.
  const step::EnergyAccount& e = run.states.back().energy;
  const double mass = 1000.0 * 0.04 * 0.04 * 0.02, paid = mass * belt * belt;
  EXPECT_NEAR(e.supplied, paid, 0.03 * paid);
  EXPECT_NEAR(e.contact_friction, 0.5 * paid, 0.03 * paid);
}

}  // namespace
}  // namespace trocar
