#include <gtest/gtest.h>

#include <cmath>

#include "support/bodies.hpp"
#include "support/cavity.hpp"

// A needle, a cavity with fluid, and two bodies that touch, in one problem.
namespace trocar {
namespace {

using core::Vec3;

constexpr double cell = 0.01;

/// A block of 5³ cells around a cavity of one cell, held below, and on it a plate that goes down by
/// 1.5 mm in a second and is `apart` from it at the start. A needle goes through the block beside
/// the cavity.
step::Scene scene_of(bool quadratic, tissue::Model model, double friction)
{
  const double size = 5 * cell;
  const auto inside = [=](const Vec3& x) {
    return (x.array() - 0.5 * size).abs().maxCoeff() < 0.5 * cell * (1.0 + 1e-9);
  };
  test::BlockShape below{5, 5, 5, Vec3::Constant(size), 0.0, inside};
  test::BlockShape plate{3, 3, 1, Vec3(0.03, 0.03, cell)};
  plate.map = [=](const Vec3& X) { return Vec3(X + Vec3(0.011, 0.009, size)); };
  below.quadratic = plate.quadratic = quadratic;
  mesh::Mesh block = test::block(below);
  test::add_surface(block, "wall", inside);
  const bool turns = model != tissue::Model::linear;
  step::Scene scene =
      test::cavity_scenario(5, 1, turns ? cavity::Model::follower : cavity::Model::linear);
  scene.mesh = test::joined(block, test::block(plate));
  scene.cavities.cavities[0].surface = "a_wall";
  test::add_needle(scene, 0.0127);
  scene.tissue.model = model;
  scene.tissue.materials = {{8000.0, 0.4, 1000.0, 0.0, 0.02}, {30000.0, 0.3, 1000.0, 0.0, 0.02}};
  scene.insertion.friction.assign(2, scene.insertion.friction[0]);
  scene.tissue.boundary.fixed = {{"a_z0", 7}};
  scene.tissue.boundary.displacements = {
      {"b_z1", Vec3(0.0005, 0, -0.0015), core::Csv{"plate", {"time", "f"}, {{0, 0}, {1, 1}}}}};
  scene.contact.pairs = {{"plate", "b_z0", "a_z1", friction}};
  scene.energy = true;
  return scene;
}

TEST(Together, ForcesOfNeedleFluidAndContactAddUp)
{
  for (const bool quadratic : {false, true})
    for (const tissue::Model model : {tissue::Model::linear, tissue::Model::corotational}) {
      SCOPED_TRACE(testing::Message() << quadratic << static_cast<int>(model));
      step::Scene scene = scene_of(quadratic, model, 0.4);
      scene.time.end = quadratic ? 0.2 : 0.6;
      const test::Run run = test::run(scene);
      const step::StepReport& last = run.reports.back();
      EXPECT_GT(last.needles[0].depth, 0.003);
      EXPECT_GT(last.needles[0].coupling.shaft_friction, 0.0);
      EXPECT_GT(last.cavities[0].pressure, 10.0);
      EXPECT_LT(last.cavities[0].error, model == tissue::Model::linear ? 0.01 : 1e-8);
      // The plate is light: what holds it is what it presses with, but for inertia and damping.
      const Vec3 held = last.holders.tools[0], pressed = last.contact[0].force;
      EXPECT_LT(pressed.z(), -0.05);
      EXPECT_NEAR((held - pressed).norm(), 0.0, 0.02 * pressed.norm());
      // Supports carry plate and needle.
      const Vec3 all = last.holders.supports[0] + held + last.needles[0].base.force;
      EXPECT_NEAR(all.norm(), 0.0, 0.02 * pressed.norm());
      EXPECT_GE(last.contact[0].weighted_gap, -1e-8);
      const step::EnergyAccount& e = run.states.back().energy;
      EXPECT_GE(e.contact, -1e-5 * e.supplied);  // gaps close to 1e-9 m
      EXPECT_GE(e.contact_friction, 0.0);
      EXPECT_GT(e.rest(), -1e-6 * e.supplied);
    }
}

// Without the plate in reach nothing of it is felt.
TEST(Together, APairThatIsApartChangesNothing)
{
  step::Scene scene = scene_of(false, tissue::Model::linear, 0.4);
  scene.tissue.boundary.displacements[0].value.z() = 0.02;
  scene.time.end = 0.2;
  const test::Run with = test::run(scene);
  scene.contact.pairs.clear();
  const test::Run without = test::run(scene);
  // In the first steps the plate is still in reach, and goes away.
  EXPECT_NEAR(with.reports.back().needles[0].base.force.x(),
              without.reports.back().needles[0].base.force.x(), 1e-7);
  EXPECT_NEAR(with.reports.back().cavities[0].pressure, without.reports.back().cavities[0].pressure,
              1e-4);
}

}  // namespace
}  // namespace trocar
