#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scene.hpp"

// A round body pressed on a rigid plane (Hertz 1882).
namespace trocar {
namespace {

using core::Vec3;

constexpr double young = 1e4, poisson = 0.3, round = 0.02;  // E [Pa], ν, R [m]
constexpr double contact_radius = 0.001;                    // wanted: a/R = 0.05
constexpr double far = 5.0 * contact_radius;                // size of the quarter that is meshed

/// A quarter of the body: a block whose lower face is the paraboloid z = r²/2R, in cells that grow
/// from a / `edges` at the middle of the contact.
step::Scene ball(bool quadratic, int edges, int cells)
{
  test::BlockShape shape{cells, cells, cells, Vec3::Ones()};
  shape.quadratic = quadratic;
  const double first = contact_radius / edges / far;
  double ratio = 1.5;  // of neighbouring cells
  for (int k = 0; k < 200; ++k) ratio = std::pow(1.0 + (ratio - 1.0) / first, 1.0 / cells);
  const auto graded = [=](double t) {
    return first * (std::pow(ratio, t * cells) - 1.0) / (ratio - 1.0);
  };
  shape.map = [=](const Vec3& X) {
    const Vec3 x = far * Vec3(graded(X.x()), graded(X.y()), graded(X.z()));
    const double bottom = (x.x() * x.x() + x.y() * x.y()) / (2.0 * round);
    return Vec3(x.x(), x.y(), bottom + x.z() * (1.0 - bottom / far));
  };
  step::Scene scene;
  scene.mesh = test::block(shape);
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{young, poisson, 1000.0, 0.0, 0.0}};
  // Half of δ = a²/R goes into the half space beyond the block; the force is what is compared.
  const double pressed = contact_radius * contact_radius / round;
  scene.tissue.boundary.displacements = {{"z1", Vec3(0, 0, -0.8 * pressed), std::nullopt}};
  scene.tissue.boundary.fixed = {{"x0", 1}, {"y0", 2}};
  scene.contact.obstacles = {{"floor"}};
  scene.contact.pairs = {{"ball", "z0", "floor"}};
  scene.contact.pairs[0].search = 0.1 * contact_radius;
  scene.time.is_static = true;
  return scene;
}

struct Found
{
  double radius;    ///< √(2.5 Σλr² / Σλ)
  double pressure;  ///< largest λ / ∫φ
  double hertz;     ///< radius of the closed form at the same force
  double peak;      ///< its largest pressure
};

Found pressed(const step::Scene& scene)
{
  const test::Run run = test::run(scene);
  const contact::PairReport& report = run.reports.back().contact[0];
  double moment = 0.0, force = 0.0;
  Found found{};
  for (const contact::CornerReport& corner : report.corners) {
    const Vec3& X = scene.mesh.x[static_cast<std::size_t>(corner.node)];
    moment += corner.force.norm() * (X.x() * X.x() + X.y() * X.y());
    force += corner.force.norm();
    found.pressure = std::max(found.pressure, corner.pressure);
  }
  EXPECT_NEAR(report.force.norm(), force, 1e-9 * force);
  found.radius = std::sqrt(2.5 * moment / force);
  const double stiff = young / (1.0 - poisson * poisson), whole = 4.0 * force;
  found.hertz = std::cbrt(0.75 * whole * round / stiff);
  found.peak = 1.5 * whole / (M_PI * found.hertz * found.hertz);
  return found;
}

// The error is that of the mesh and falls with it. A tet of the grid is a third longer than a cell.
TEST(Hertz, RadiusAndPressureTendToTheClosedForm)
{
  for (const bool quadratic : {false, true}) {
    SCOPED_TRACE(quadratic);
    const Found coarse = pressed(quadratic ? ball(true, 4, 8) : ball(false, 6, 10));
    const Found fine = pressed(quadratic ? ball(true, 7, 11) : ball(false, 12, 16));
    const double off = std::abs(fine.radius / fine.hertz - 1.0);
    EXPECT_LT(off, 0.05);
    EXPECT_LT(off, 0.55 * std::abs(coarse.radius / coarse.hertz - 1.0));
    EXPECT_NEAR(fine.pressure, fine.peak, (quadratic ? 0.1 : 0.25) * fine.peak);
    EXPECT_NEAR(fine.hertz, contact_radius, 0.2 * contact_radius);
  }
}

}  // namespace
}  // namespace trocar
