#include <gtest/gtest.h>

#include "support/body.hpp"

namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;
using test::nodal;

tissue::TissueSettings all_faces_held(tissue::Model model)
{
  tissue::TissueSettings settings;
  settings.model = model;
  settings.materials = {{4000.0, 0.3, 1000.0, 0.0, 0.0}};
  for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
    settings.boundary.fixed.push_back({side, 7});
  return settings;
}

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
      const fem::OwnedField r = body.tissue.residual(old, u, at_rest);
      if (iteration == 0) body.tissue.prepare(at_rest);
      u.value += body.tissue.factor().answer(r).value;
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
    const tissue::TissueState old = tissue::at_rest(body.space);
    const auto force = [&](const fem::OwnedField& u) {
      const auto r = body.tissue.residual(old, u, at_rest);
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
  const tissue::TissueState old = tissue::at_rest(body.space);
  auto at = body.tissue.linearise(old, old.u, at_rest);
  const auto exact =
      nodal(body, [](const Vec3& X) { return Vec3(0.01 * X.x(), -0.003 * X.y(), -0.003 * X.z()); });
  EXPECT_LT(body.comm.max((at->alone().value - exact.value).cwiseAbs().maxCoeff()), 1e-13);
}

}  // namespace
}  // namespace trocar
