#include <gtest/gtest.h>

#include <cmath>

#include "core/failure.hpp"
#include "support/bodies.hpp"
#include "support/scene.hpp"

// Statics of bodies that contact alone holds (docs/theory.md section 14).
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;

constexpr double young = 5000.0, poisson = 0.3, density = 1000.0, g = 9.81;
constexpr double wide = 0.04, narrow = 0.03, high = 0.02;

struct Kind
{
  bool quadratic = false;
  tissue::Model model = tissue::Model::linear;
  double friction = 0.5;
};

Mat3 turn(double angle)
{
  return Eigen::AngleAxisd(angle, Vec3(0.3, 0.9, 0.2).normalized()).toRotationMatrix();
}

/// A block held below, and a smaller one on it that nothing else holds, all turned by an angle.
step::Scene stack(const Kind& kind, double angle)
{
  test::BlockShape lower{4, 4, 2, Vec3(wide, wide, high)};
  test::BlockShape upper{3, 3, 3, Vec3(narrow, narrow, high)};
  lower.quadratic = upper.quadratic = kind.quadratic;
  upper.map = [](const Vec3& X) { return Vec3(X + Vec3(0.004, 0.005, high)); };
  step::Scene scene;
  scene.mesh = test::joined(test::block(lower), test::block(upper));
  for (Vec3& x : scene.mesh.x) x = turn(angle) * x;
  scene.tissue.model = kind.model;
  scene.tissue.materials.assign(2, {young, poisson, density, 0.0, 0.0});
  scene.tissue.boundary.fixed = {{"a_z0", 7}};
  scene.contact.pairs = {{"faces", "b_z0", "a_z1", kind.friction}};
  scene.time.is_static = true;
  return scene;
}

TEST(HeldByContact, ABlockCarriesItsLoad)
{
  for (const bool quadratic : {false, true})
    for (const tissue::Model model : {tissue::Model::linear, tissue::Model::corotational})
      for (const double angle : {0.0, 0.5}) {
        SCOPED_TRACE(testing::Message() << quadratic << int(model) << angle);
        step::Scene scene = stack({quadratic, model, 0.5}, angle);
        const Vec3 down = turn(angle) * Vec3(0, 0, -1.0);
        scene.tissue.boundary.tractions = {{"b_z1", 20.0 * down, std::nullopt}};
        scene.tissue.boundary.gravity = g * down;
        const test::Run run = test::run(scene);
        const double load = 20.0 * narrow * narrow + density * g * narrow * narrow * high;
        const step::StepReport& report = run.reports.back();
        EXPECT_LT((report.contact[0].force - load * down).norm(), 1e-8 * load);
        EXPECT_LE(report.linearisations, model == tissue::Model::linear ? 6 : 10);
      }
}

// A body that slides along a smooth plane is not held; one that its own supports hold sideways is.
TEST(HeldByContact, SupportsMayDoAPart)
{
  step::Scene scene = stack({false, tissue::Model::linear, 0.0}, 0.0);
  scene.tissue.boundary.gravity = Vec3(1.0, 0, -g);
  EXPECT_THROW(test::run(scene), core::Failure);
  scene.tissue.boundary.fixed.push_back({"b_z1", 3});  // may sink
  const test::Run run = test::run(scene);
  const double load = density * g * narrow * narrow * high;
  EXPECT_NEAR(run.reports.back().contact[0].force.z(), -load, 1e-8 * load);
}

/// A block on a rigid plane, tan(slope) = `steepness` · friction.
step::Scene on_slope(double steepness)
{
  step::Scene scene;
  scene.mesh = test::block({4, 4, 2, Vec3(wide, wide, high)});
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{young, poisson, density, 0.0, 0.0}};
  const double angle = std::atan(steepness * 0.5);
  scene.tissue.boundary.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  scene.contact.obstacles = {{"floor"}};
  scene.contact.pairs = {{"floor", "z0", "floor", 0.5}};
  scene.time.is_static = true;
  return scene;
}

std::string refusal_of(const step::Scene& scene)
{
  try {
    test::run(scene);
  } catch (const core::Failure& failure) {
    return failure.what();
  }
  return {};
}

TEST(HeldByContact, FrictionHoldsToItsLimit)
{
  const double load = density * g * wide * wide * high;
  for (const double steepness : {0.0, 0.5, 0.9, 0.998}) {
    const test::Run run = test::run(on_slope(steepness));
    EXPECT_NEAR(run.reports.back().contact[0].force.norm(), load, 1e-7 * load) << steepness;
  }
  EXPECT_NE(refusal_of(on_slope(1.002)).find("hold the tissue"), std::string::npos);
}

TEST(HeldByContact, ABodyThatIsPulledOffIsNotHeld)
{
  step::Scene scene = stack({}, 0.0);
  scene.tissue.boundary.gravity = Vec3(0, 0, g);
  EXPECT_NE(refusal_of(scene).find("hold part 2 of 2, volume 'b_"), std::string::npos)
      << refusal_of(scene);
}

TEST(HeldByContact, ABodyInNoPairNeedsSupports)
{
  step::Scene scene = stack({}, 0.0);
  scene.contact.pairs.clear();
  EXPECT_NE(refusal_of(scene).find("part 2 of 2"), std::string::npos);
}

}  // namespace
}  // namespace trocar
