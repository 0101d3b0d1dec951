#include <gtest/gtest.h>

#include <cmath>

#include "support/bodies.hpp"
#include "support/scene.hpp"

// Uniform pressure between two bodies whose meshes do not match (docs/theory.md section 14).
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;

struct Patch
{
  bool quadratic;
  bool upper_is_slave;
  double angle;  ///< by which everything is turned [rad]
  double friction;
};

constexpr double young = 5000.0, pressure = 50.0, poisson = 0.3;
constexpr double wide = 0.04, narrow = 0.03, high = 0.02;

/// About an axis that is none of the mesh's.
Mat3 turn(double angle)
{
  return Eigen::AngleAxisd(angle, Vec3(0.3, 0.9, 0.2).normalized()).toRotationMatrix();
}

/// A wide block in 4 x 4 cells, and on its corner at the origin a narrower one in 5 x 5 cells. The
/// part of the wide one that the narrow one leaves free is the surface "bare".
mesh::Mesh blocks(const Patch& patch)
{
  test::BlockShape lower{4, 4, 2, Vec3(wide, wide, high)};
  test::BlockShape upper{5, 5, 3, Vec3(narrow, narrow, high)};
  lower.quadratic = upper.quadratic = patch.quadratic;
  upper.map = [](const Vec3& X) { return Vec3(X + Vec3(0, 0, high)); };
  mesh::Mesh mesh = test::joined(test::block(lower), test::block(upper));
  mesh::SurfaceGroup bare{"bare", {}};
  for (const mesh::Face& face : mesh::surface_group(mesh, "a_z1").faces) {
    Vec3 middle = Vec3::Zero();
    for (int node : face) middle += mesh.x[static_cast<std::size_t>(node)] / 3.0;
    if (middle.x() > narrow || middle.y() > narrow) bare.faces.push_back(face);
  }
  mesh.surfaces.push_back(bare);
  for (Vec3& x : mesh.x) x = turn(patch.angle) * x;
  return mesh;
}

/// The displacement of uniform pressure along the third axis, unturned. The upper block sinks with
/// the lower one's surface.
Vec3 exact(const Vec3& X, const Mat3& R)
{
  const Vec3 x = R.transpose() * X;
  const double strain = -pressure / young;
  return R * Vec3(-poisson * strain * x.x(), -poisson * strain * x.y(), strain * x.z());
}

step::Scene scene_of(const Patch& patch)
{
  step::Scene scene;
  scene.mesh = blocks(patch);
  const Mat3 R = turn(patch.angle);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials.assign(2, {young, poisson, 1000.0, 0.0, 0.0});
  scene.tissue.boundary.tractions = {{"bare", R * Vec3(0, 0, -pressure), std::nullopt}};
  // The outer ends of both blocks move as the exact solution does.
  for (const char* end : {"a_z0", "b_z1"}) {
    tissue::PrescribedDisplacement held{end, Vec3::Zero(), std::nullopt};
    for (int node : mesh::group_nodes(scene.mesh, end))
      held.field[node] = exact(scene.mesh.x[static_cast<std::size_t>(node)], R);
    if (patch.quadratic)
      for (const mesh::Face& face : mesh::surface_group(scene.mesh, end).faces)
        for (std::size_t k = 0; k < 3; ++k) {
          const int node = scene.mesh.middle_of(face[k], face[(k + 1) % 3]);
          held.field[node] = exact(scene.mesh.x[static_cast<std::size_t>(node)], R);
        }
    scene.tissue.boundary.displacements.push_back(held);
  }
  contact::PairSettings pair{"faces", "a_z1", "b_z0"};
  if (patch.upper_is_slave) std::swap(pair.slave, pair.master);
  pair.friction = patch.friction;
  scene.contact.pairs = {pair};
  scene.time.is_static = true;
  scene.laws.tolerance = 1e-13;
  scene.tissue.newton_tolerance = 1e-8;
  return scene;
}

TEST(ContactPatch, PressureIsUniform)
{
  for (const bool quadratic : {false, true})
    for (const bool upper : {false, true})
      for (const double angle : {0.0, std::acos(-1.0) / 6.0})
        for (const double friction : {0.0, 0.5}) {
          SCOPED_TRACE(testing::Message() << quadratic << upper << angle << friction);
          const Patch patch{quadratic, upper, angle, friction};
          const step::Scene scene = scene_of(patch);
          const test::Run run = test::run(scene);
          const base::Comm comm(MPI_COMM_WORLD);
          step::Model model(scene, comm);
          const fem::GlobalField u = model.space.gather(run.states.back().tissue.u);
          const Mat3 R = turn(angle);
          double worst = 0.0;
          for (int n = 0; n < scene.mesh.node_count(); ++n)
            worst = std::max(
                worst, (u.node(n) - exact(scene.mesh.x[static_cast<std::size_t>(n)], R)).norm());
          EXPECT_LT(worst, 1e-9 * high * pressure / young);
          EXPECT_EQ(run.reports.back().linearisations, 1);
          const contact::PairReport& report = run.reports.back().contact[0];
          EXPECT_NEAR(report.force.norm(), pressure * narrow * narrow, 1e-9);
          const double width = narrow * (1.0 + poisson * pressure / young);  // it is squeezed wider
          EXPECT_NEAR(report.area, width * width, 1e-9 * width * width);
        }
}

/// The same with pressure on the upper block. Contact holds it, alone with friction; without
/// friction, where a block on a soft one may slide off, its upper end is guided sideways.
step::Scene loaded(const Patch& patch)
{
  step::Scene scene = scene_of(patch);
  tissue::PrescribedDisplacement& end = scene.tissue.boundary.displacements.back();
  for (auto& [node, value] : end.field) value.z() = std::nan("");
  end.value.z() = std::nan("");
  if (patch.friction > 0.0) scene.tissue.boundary.displacements.pop_back();
  scene.tissue.boundary.tractions.push_back(
      {"b_z1", turn(patch.angle) * Vec3(0, 0, -pressure), std::nullopt});
  scene.laws.tolerance = 1e-11;  // first it falls some hundred metres
  scene.tissue.newton_tolerance = patch.quadratic ? 1e-7 : 1e-10;  // of the least loaded node
  return scene;
}

TEST(ContactPatch, StressIsUniformInABodyThatContactHolds)
{
  for (const bool quadratic : {false, true})
    for (const bool upper : {false, true})
      for (const double angle : {0.0, std::acos(-1.0) / 6.0})
        for (const double friction : {0.0, 0.5}) {
          if (friction == 0.0 && angle > 0.0) continue;  // guides are along the axes
          SCOPED_TRACE(testing::Message() << quadratic << upper << angle << friction);
          const step::Scene scene = loaded({quadratic, upper, angle, friction});
          const test::Run run = test::run(scene);
          const base::Comm comm(MPI_COMM_WORLD);
          step::Model model(scene, comm);
          const core::VecX stress = model.tissue.stresses(run.states.back().tissue.u).stress;
          const Mat3 R = turn(angle);
          const Mat3 S = R * Vec3(0, 0, -pressure).asDiagonal() * R.transpose();
          Eigen::Matrix<double, 6, 1> expected;
          expected << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(0, 2);
          double worst = 0.0;
          for (Eigen::Index t = 0; t < stress.size(); t += 6)
            worst = std::max(worst, (stress.segment<6>(t) - expected).cwiseAbs().maxCoeff());
          EXPECT_LT(worst, (friction > 0.0 ? 1e-9 : 1e-10) * pressure);
          const double wider = 1.0 + poisson * pressure / young;  // than the area of the load
          for (const contact::CornerReport& corner : run.reports.back().contact[0].corners)
            EXPECT_NEAR(wider * wider * corner.pressure, pressure, 1e-7 * pressure);
        }
}

// A master with two layers within the search distance, both facing the slave: the nearer one is
// met.
TEST(ContactPatch, OfTwoLayersTheNearerIsMet)
{
  test::BlockShape lower{4, 4, 2, Vec3(wide, wide, high)}, slab{3, 3, 1, Vec3(wide, wide, 0.004)};
  slab.map = [](const Vec3& X) { return Vec3(X + Vec3(0, 0, high)); };
  test::BlockShape lid = slab;
  lid.map = [](const Vec3& X) { return Vec3(X + Vec3(0, 0, high + 0.005)); };
  step::Scene scene;
  scene.mesh = test::joined(test::joined(test::block(lower), test::block(slab)), test::block(lid));
  mesh::SurfaceGroup layers{"layers", mesh::surface_group(scene.mesh, "a_b_z0").faces};
  for (const mesh::Face& face : mesh::surface_group(scene.mesh, "b_z0").faces)
    layers.faces.push_back(face);
  scene.mesh.surfaces.push_back(layers);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials.assign(3, {young, poisson, 1000.0, 0.0, 0.0});
  scene.tissue.boundary.fixed = {{"a_b_z1", 7}, {"b_z1", 7}};
  scene.tissue.boundary.displacements = {{"a_a_z0", Vec3(0, 0, 0.001), std::nullopt}};
  scene.contact.pairs = {{"faces", "a_a_z1", "layers"}};
  scene.time.is_static = true;
  const contact::PairReport both = test::run(scene).reports.back().contact[0];
  scene.contact.pairs[0].master = "a_b_z0";
  const contact::PairReport near = test::run(scene).reports.back().contact[0];
  EXPECT_GT(near.force.z(), 0.1);
  EXPECT_NEAR(both.force.z(), near.force.z(), 1e-9);
  EXPECT_NEAR(both.area, near.area, 1e-12);
}

}  // namespace
}  // namespace trocar
