#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/elements.hpp"

// All elements and laws by what must hold for any of them: energy, forces and operator belong
// together, linear fields are exact, mass and weight are those of the body.
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;
using test::at_rest;
using test::deformed;
using test::direction;
using test::Kind;
using test::kinds;
using test::settings_of;
using test::shape_of;
using tissue::Model;
using tissue::Tangent;

fem::OwnedField inner_forces(const test::Body& body, const fem::OwnedField& u)
{
  return {-body.tissue.residual(tissue::at_rest(body.space), u, at_rest).value};
}

double energy(const test::Body& body, const fem::OwnedField& u)
{
  const tissue::TissueState state{u, body.space.zero()};
  return body.tissue.work(state, state, state, at_rest, body.space.zero()).elastic;
}

TEST(Elements, ForcesAreTheDerivativeOfTheEnergy)
{
  for (const Kind& kind : kinds) {
    const test::Body body(shape_of(kind), settings_of(kind));
    const fem::OwnedField u = test::nodal(body, deformed), d = test::nodal(body, direction);
    const double step = 1e-5;
    const double by_energy =
        (energy(body, {u.value + step * d.value}) - energy(body, {u.value - step * d.value})) /
        (2.0 * step);
    const double by_forces = body.space.dot(inner_forces(body, u), d);
    EXPECT_NEAR(by_energy, by_forces, 1e-7 * std::abs(by_forces)) << kind.name;
  }
}

// ‖f(u + εd) - f(u) - ε K d‖ falls with ε².
TEST(Elements, RemainderOfEveryExactTangentIsQuadratic)
{
  for (const Kind& kind : kinds) {
    if (kind.model == Model::linear) continue;
    test::Body body(shape_of(kind), settings_of(kind));
    const fem::OwnedField u = test::nodal(body, deformed), d = test::nodal(body, direction);
    tissue::LinearisationPoint at;
    ASSERT_TRUE(body.tissue.configure(body.space.with_ghosts(u), at));
    body.tissue.assemble(at, {});
    const fem::OwnedField K_d = body.tissue.times(d), f = inner_forces(body, u);
    std::vector<double> rest;
    for (double step : {0.02, 0.01, 0.005}) {
      const fem::OwnedField moved = inner_forces(body, {u.value + step * d.value});
      rest.push_back(body.space.norm({moved.value - f.value - step * K_d.value}));
    }
    EXPECT_NEAR(std::log2(rest[1] / rest[2]), 2.0, 0.02) << kind.name;
  }
}

// With the rotations held the operator is that of the rotated linear tissue: forces are linear.
TEST(Elements, MatrixAndElementLoopAreOneOperator)
{
  for (Kind kind : kinds)
    for (Tangent tangent : {Tangent::rotated, Tangent::exact}) {
      kind.tangent = tangent;
      tissue::TissueSettings settings = settings_of(kind);
      settings.materials[0].rayleigh_mass = 3.0;
      settings.materials[0].rayleigh_stiffness = 0.02;
      test::Body body(shape_of(kind), settings);
      const fem::OwnedField u = test::nodal(body, deformed), d = test::nodal(body, direction);
      tissue::LinearisationPoint at;
      ASSERT_TRUE(body.tissue.configure(body.space.with_ghosts(u), at));
      body.tissue.assemble(at, {100.0, 100.0});
      const fem::OwnedField by_matrix = body.tissue.times(d);
      const fem::OwnedField by_loop = body.tissue.operate_by_elements(at, {100.0, 100.0}, d);
      EXPECT_LT(body.space.norm({by_matrix.value - by_loop.value}),
                1e-12 * body.space.norm(by_loop))
          << kind.name;
    }
}

// A point that is configured again keeps nothing of the tangent it was last configured for: points
// are compared to know whether an operator is at hand.
TEST(Elements, PointOfTheRotatedTangentHasNothingOfTheExactOne)
{
  for (Kind kind : kinds) {
    if (kind.model != Model::corotational) continue;
    kind.tangent = Tangent::automatic;
    test::Body body(shape_of(kind), settings_of(kind));
    const auto u = body.space.with_ghosts(test::nodal(body, deformed));
    tissue::LinearisationPoint rotated, exact;
    ASSERT_TRUE(body.tissue.configure(u, rotated));
    ASSERT_TRUE(body.tissue.tangent().take_exact());
    ASSERT_TRUE(body.tissue.configure(u, exact));
    EXPECT_FALSE(exact == rotated) << kind.name;
    ASSERT_TRUE(body.tissue.tangent().drop_exact());
    ASSERT_TRUE(body.tissue.configure(u, exact));
    EXPECT_TRUE(exact == rotated) << kind.name;
  }
}

// A linear displacement is in equilibrium on any mesh. With curved tets inside a body it is so to
// the integration's error: four points do not integrate the cubic products of a curved tet.
TEST(Elements, PassThePatchTest)
{
  for (const Kind& kind : kinds)
    for (bool curved : {false, true}) {
      test::BlockShape shape = shape_of(kind);
      if (!curved) shape.map = {};
      const test::Body body(shape, settings_of(kind));
      Mat3 A;
      A << 0.02, 0.03, -0.01, 0.0, -0.04, 0.02, 0.01, 0.05, 0.03;
      const fem::OwnedField f =
          inner_forces(body, test::nodal(body, [&](const Vec3& X) { return Vec3(A * X); }));
      std::set<int> outer;
      for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
        for (int node : mesh::group_nodes(body.mesh, side)) outer.insert(node);
      double inside = 0.0, largest = 0.0;
      for (int i = 0; i < body.space.owned(); ++i) {
        const double mine = f.node(i).cwiseAbs().maxCoeff();
        if (!outer.count(body.space.file_node(i))) inside = std::max(inside, mine);
        largest = std::max(largest, mine);
      }
      const double close = curved && kind.quadratic ? 1e-4 : 1e-13;
      EXPECT_LT(body.comm.max(inside), close * body.comm.max(largest)) << kind.name;
    }
}

// Kinetic energy of a translation and the sum of the weights: those of the body's mass.
TEST(Elements, HaveTheMassOfTheBody)
{
  for (const Kind& kind : kinds)
    for (tissue::Mass mass : {tissue::Mass::consistent, tissue::Mass::lumped}) {
      tissue::TissueSettings settings = settings_of(kind);
      settings.mass = mass;
      settings.boundary.gravity = Vec3(0, 0, -10);
      const test::Body body(shape_of(kind), settings);
      double volume = 0.0;  // of the mapped block, by its own map's Jacobian on a fine grid
      constexpr int n = 60;
      const Vec3 size(0.15, 0.1, 0.1);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          for (int k = 0; k < n; ++k) {
            const Vec3 X((i + 0.5) / n * size.x(), (j + 0.5) / n * size.y(),
                         (k + 0.5) / n * size.z());
            Mat3 J = Mat3::Identity();
            J(0, 1) += 0.6 * X.y();
            J(1, 2) += 0.3 * X.x();
            J(1, 0) += 0.3 * X.z();
            J(2, 0) += 0.6 * X.x();
            volume += J.determinant() * size.prod() / (n * n * n);
          }
      const tissue::TissueState moving{
          body.space.zero(), test::nodal(body, [](const Vec3&) { return Vec3(2, 0, 0); })};
      const core::TimeStep step{0.01, 0.01, false};
      const double kinetic =
          body.tissue.work(moving, moving, moving, step, body.space.zero()).kinetic;
      // Only quadratic tets follow the curved sides; straight ones miss 0.1 % of the volume.
      const double close = kind.quadratic ? 3e-5 : 3e-3;
      EXPECT_NEAR(kinetic, 0.5 * 1000.0 * volume * 4.0, close * 2000.0 * volume) << kind.name;
      const fem::OwnedField f = inner_forces(body, body.space.zero());
      core::VecX weight = core::VecX::Zero(1);
      for (int i = 0; i < body.space.owned(); ++i) weight[0] += f.node(i).z();
      body.comm.sum(weight);
      EXPECT_NEAR(weight[0], 1000.0 * 10.0 * volume, close * 1e4 * volume) << kind.name;
      const double by_mass = 20.0 * kinetic / 4.0;
      EXPECT_NEAR(weight[0], by_mass, 1e-10 * by_mass) << kind.name;
    }
}

}  // namespace
}  // namespace trocar
