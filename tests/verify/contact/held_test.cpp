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
  tissue::Dilatation dilatation = tissue::Dilatation::pointwise;
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
  scene.tissue.dilatation = kind.dilatation;
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

// Every element and law.
TEST(HeldByContact, ByAnyElement)
{
  using tissue::Dilatation;
  using tissue::Model;
  const std::vector<Kind> kinds{{false, Model::neo_hookean, 0.5, Dilatation::pointwise},
                                {false, Model::corotational, 0.5, Dilatation::nodal},
                                {false, Model::neo_hookean, 0.5, Dilatation::nodal},
                                {true, Model::linear, 0.5, Dilatation::element},
                                {true, Model::neo_hookean, 0.5, Dilatation::element},
                                {true, Model::corotational, 0.5, Dilatation::nodal}};
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(testing::Message() << kind.quadratic << static_cast<int>(kind.model)
                                    << static_cast<int>(kind.dilatation));
    step::Scene scene = stack(kind, 0.2);
    const Vec3 down = turn(0.2) * Vec3(0, 0, -1.0);
    scene.tissue.boundary.gravity = g * down;
    const test::Run run = test::run(scene);
    const double load = density * g * narrow * narrow * high;
    EXPECT_LT((run.reports.back().contact[0].force - load * down).norm(), 1e-7 * load);
    const bool exact = kind.model == tissue::Model::neo_hookean;  // then the proximal term is large
    EXPECT_LE(run.reports.back().linearisations, exact ? 25 : 12);
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

// A slender strip on two bars, across which it sags: small beside its bending stiffness too.
TEST(HeldByContact, AStripOnTwoBars)
{
  step::Scene scene;
  test::BlockShape shape{20, 2, 1, Vec3(0.1, 0.01, 0.002)};
  shape.quadratic = true;
  scene.mesh = test::block(shape);
  mesh::SurfaceGroup ends{"ends", {}}, middle{"middle", {}};
  for (const mesh::Face& face : mesh::surface_group(scene.mesh, "z0").faces) {
    double x = 0.0;
    for (int node : face) x += scene.mesh.x[static_cast<std::size_t>(node)].x() / 3.0;
    (std::abs(x - 0.05) > 0.04 ? ends : middle).faces.push_back(face);
  }
  scene.mesh.surfaces.push_back(ends);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{1e7, poisson, density, 0.0, 0.0}};
  scene.tissue.boundary.gravity = Vec3(0, 0, -g);
  scene.contact.obstacles = {{"bars"}};
  scene.contact.pairs = {{"bars", "ends", "bars", 0.3}};
  scene.time.is_static = true;
  const test::Run run = test::run(scene);
  const double weight = density * g * 0.1 * 0.01 * 0.002;
  EXPECT_NEAR(run.reports.back().contact[0].force.z(), -weight, 1e-7 * weight);
  EXPECT_LE(run.reports.back().linearisations, 12);
}

// What the laws may leave open is small beside the forces of a stiff body too.
TEST(HeldByContact, AStiffBody)
{
  for (const double stiff : {1e8, 1e9, 1e10})
    for (const double friction : {0.0, 0.3}) {
      step::Scene scene = on_slope(0.0);
      scene.tissue.materials[0].young = stiff;
      scene.contact.pairs[0].friction = friction;
      const test::Run run = test::run(scene);
      const double weight = density * g * wide * wide * high;
      EXPECT_NEAR(run.reports.back().contact[0].force.z(), -weight, 1e-7 * weight) << stiff;
    }
}

/// Blocks on one another, soft and stiff ones in turn, on the floor.
step::Scene tower(int blocks, double friction)
{
  step::Scene scene;
  std::string prefix;
  for (int k = 0; k < blocks; ++k) {
    test::BlockShape shape{2 + k % 2, 2 + k % 2, 2, Vec3(narrow, narrow, high)};
    shape.map = [k](const Vec3& X) { return Vec3(X + Vec3(0.001 * (k % 3), 0, k * high)); };
    const mesh::Mesh block = test::block(shape);
    scene.mesh = k == 0 ? block : test::joined(block, scene.mesh);
  }
  // The last block is named first: "a_…", the one before "b_a_…", and the first "b_…b_…".
  for (int k = blocks - 1; k >= 0; --k) {
    const std::string own = prefix + (k > 0 ? "a_" : "");
    const std::string below = prefix + (k > 1 ? "b_a_" : "b_");
    scene.tissue.materials.push_back({k % 2 == 0 ? 1e7 : young, poisson, density, 0.0, 0.0});
    scene.contact.pairs.push_back(
        {"under " + std::to_string(k), own + "z0", k > 0 ? below + "z1" : "floor", friction});
    prefix += "b_";
  }
  scene.contact.obstacles = {{"floor"}};
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.boundary.gravity = Vec3(0, 0, -g);
  return scene;
}

TEST(HeldByContact, ATowerCarriesItself)
{
  constexpr int blocks = 5;
  for (const double friction : {0.3, 1.0}) {
    step::Scene scene = tower(blocks, friction);
    scene.time.is_static = true;
    const test::Run run = test::run(scene);
    const double weight = density * g * narrow * narrow * high;
    for (int k = 0; k < blocks; ++k) {
      const contact::PairReport& report =
          run.reports.back().contact[static_cast<std::size_t>(blocks - 1 - k)];
      EXPECT_NEAR(report.force.z(), -(blocks - k) * weight, 1e-6 * weight) << k;
      EXPECT_LT(report.force.head<2>().norm(), 1e-6 * weight) << k;
    }
  }
}

// At rest, nothing changes any more: the same corners touch and stick over all steps.
TEST(HeldByContact, ATowerStandsStill)
{
  step::Scene scene = tower(3, 0.5);
  scene.time.start_in_equilibrium = true;
  scene.time.step = 0.005;
  scene.time.end = 0.5;
  const test::Run run = test::run(scene);
  const auto& first = run.reports[1];
  for (std::size_t n = 2; n < run.reports.size(); ++n)
    for (std::size_t p = 0; p < 3; ++p) {
      EXPECT_EQ(run.reports[n].contact[p].sticking, first.contact[p].sticking) << n << ' ' << p;
      EXPECT_EQ(run.reports[n].contact[p].slipping, first.contact[p].slipping) << n << ' ' << p;
    }
  const core::VecX moved = run.states.back().tissue.u.value - run.states.front().tissue.u.value;
  EXPECT_LT(moved.size() > 0 ? moved.cwiseAbs().maxCoeff() : 0.0, 1e-8);
}

}  // namespace
}  // namespace trocar
