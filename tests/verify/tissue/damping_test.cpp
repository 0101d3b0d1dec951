#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/elements.hpp"
#include "support/scene.hpp"

// Stiffness damping of every element and law: one viscous stress in forces, operator and energy.
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;
using test::Kind;
using tissue::Model;
using tissue::Tangent;

constexpr double beta = 0.02, h = 0.01;

/// A body with damping, and the same without.
struct Pair
{
  static tissue::TissueSettings damped(const Kind& kind, double by)
  {
    tissue::TissueSettings settings = test::settings_of(kind);
    settings.materials[0].rayleigh_stiffness = by;
    return settings;
  }
  explicit Pair(const Kind& kind)
      : with(test::shape_of(kind), damped(kind, beta)),
        without(test::shape_of(kind), damped(kind, 0.0))
  {
  }

  fem::OwnedField viscous(const fem::OwnedField& u, const fem::OwnedField& v) const
  {
    const tissue::TissueState old{{u.value - h * v.value}, v};
    return {without.tissue.residual(old, u, {h, h, false}).value -
            with.tissue.residual(old, u, {h, h, false}).value};
  }
  double power(const fem::OwnedField& u, const fem::OwnedField& v) const
  {
    const tissue::TissueState now{u, v};
    return with.tissue.work(now, now, now, {h, h, false}, with.space.zero()).damped / h;
  }

  test::Body with, without;
};

/// Every kind, corotational ones with both tangents.
std::vector<Kind> all_kinds()
{
  std::vector<Kind> all = test::kinds;
  for (const Kind& kind : test::kinds)
    if (kind.model == Model::corotational)
      all.push_back({kind.name, kind.model, Tangent::rotated, kind.quadratic, kind.dilatation});
  return all;
}

Vec3 some_velocity(const Vec3& X)
{
  return Vec3(std::cos(20 * X.y()), std::sin(15 * X.z() + 1), std::cos(30 * X.x() - X.y()));
}

// The power is a quadratic form of the velocity, never negative; half of it is what the forces are
// the derivative of.
TEST(Damping, ForcesAreTheDerivativeOfHalfThePower)
{
  for (const Kind& kind : all_kinds()) {
    const Pair pair(kind);
    const fem::OwnedField u = test::nodal(pair.with, test::deformed);
    const fem::OwnedField v = test::nodal(pair.with, some_velocity);
    const fem::OwnedField d = test::nodal(pair.with, test::direction);
    const fem::OwnedField f = pair.viscous(u, v);
    const double power = pair.power(u, v);
    EXPECT_GT(power, 0.0) << kind.name;
    EXPECT_NEAR(pair.with.space.dot(f, v), power, 1e-11 * power) << kind.name;
    const double slope =
        0.25 * (pair.power(u, {v.value + d.value}) - pair.power(u, {v.value - d.value}));
    EXPECT_NEAR(pair.with.space.dot(f, d), slope, 1e-10 * power) << kind.name;
  }
}

TEST(Damping, OperatorHoldsTheSameForces)
{
  constexpr core::Rates rate{100.0, 150.0};
  for (const Kind& kind : all_kinds()) {
    Pair pair(kind);
    const fem::OwnedField u = test::nodal(pair.with, test::deformed);
    const fem::OwnedField d = test::nodal(pair.with, test::direction);
    const auto times = [&](test::Body& body) {
      tissue::LinearisationPoint at;
      EXPECT_TRUE(body.tissue.configure(body.space.with_ghosts(u), at));
      body.tissue.assemble(at, rate);
      return body.tissue.times(d).value;
    };
    const core::VecX by_operator = (times(pair.with) - times(pair.without)) / rate.velocity;
    const fem::OwnedField f = pair.viscous(u, d);
    EXPECT_LT(pair.with.space.norm({by_operator - f.value}), 1e-10 * pair.with.space.norm(f))
        << kind.name;
  }
}

TEST(Damping, IsBetaKAtRest)
{
  for (const Kind& kind : all_kinds()) {
    Pair pair(kind);
    const fem::OwnedField rest = pair.with.space.zero();
    const fem::OwnedField v = test::nodal(pair.with, some_velocity);
    tissue::LinearisationPoint at;
    ASSERT_TRUE(pair.without.tissue.configure(pair.without.space.with_ghosts(rest), at));
    pair.without.tissue.assemble(at, {});
    const fem::OwnedField f = pair.viscous(rest, v);
    const core::VecX K_v = pair.without.tissue.times(v).value;
    EXPECT_LT(pair.with.space.norm({f.value - beta * K_v}), 1e-11 * pair.with.space.norm(f))
        << kind.name;
  }
}

// A compressed body that spins dissipates nothing: a neo-Hookean one pressed along an axis, a
// corotational one (K₀ in its frame) from all sides.
TEST(Damping, OfASpinIsNone)
{
  const Mat3 Q = core::rotation_exp(Vec3(0.4, -0.3, 0.6));
  const Vec3 spin(1.0, 2.0, -0.5);
  for (const Kind& kind : all_kinds()) {
    if (kind.model == Model::linear) continue;
    const Pair pair(kind);
    const double across = kind.model == Model::neo_hookean ? 1.0 : 0.98;
    const Mat3 F = Q * Vec3(0.98, across, across).asDiagonal();
    const auto u = test::nodal(pair.with, [&](const Vec3& X) { return Vec3(F * X - X); });
    const auto v = test::nodal(pair.with, [&](const Vec3& X) { return Vec3(spin.cross(F * X)); });
    const auto other = test::nodal(pair.with, [&](const Vec3& X) { return Vec3(F * X * 2.0); });
    EXPECT_LT(pair.with.space.norm(pair.viscous(u, v)),
              1e-12 * pair.with.space.norm(pair.viscous(u, other)))
        << kind.name;
  }
}

/// A stretched block let go but for a fifth, damped: displacements after 0.03 s.
core::VecX let_go(Model model, Tangent tangent, double step, int linearisations)
{
  step::Scene scenario = test::needle_scenario({3, 2, 2, Vec3(0.06, 0.03, 0.03), 0.1});
  scenario.needles.clear();
  scenario.tissue.model = model;
  scenario.tissue.tangent = tangent;
  scenario.tissue.materials = {{5000.0, 0.45, 1000.0, 0.0, 0.01}};
  scenario.tissue.boundary.fixed = {{"x0", 7}};
  scenario.tissue.boundary.tractions = {
      {"x1", Vec3(1500.0, 0.0, 60.0), core::parse_csv("time,factor\n0,1\n0.03,0.2\n", "test")}};
  scenario.time.start_in_equilibrium = true;
  scenario.time.step = step;
  scenario.time.end = 0.03;
  scenario.time.newton_max = linearisations;
  return test::run(scenario).states.back().tissue.u.value;
}

// One linearisation a step and iterated steps approach each other as steps do.
TEST(Damping, OneLinearisationComesNearIteratedSteps)
{
  struct Law
  {
    const char* name;
    Model model;
    Tangent tangent;
  };
  for (const Law& law : {Law{"neo-Hookean", Model::neo_hookean, Tangent::rotated},
                         Law{"corotational, exact", Model::corotational, Tangent::exact}}) {
    std::vector<double> apart;
    for (double step : {0.0025, 0.00125, 0.000625}) {
      const core::VecX once = let_go(law.model, law.tangent, step, 1);
      const core::VecX iterated = let_go(law.model, law.tangent, step, 60);
      const base::Comm comm(MPI_COMM_WORLD);
      apart.push_back(
          std::sqrt(comm.sum((once - iterated).squaredNorm()) / comm.sum(iterated.squaredNorm())));
    }
    const double order = std::log2(apart[1] / apart[2]);
    std::printf("[ damped ] %s: apart %.2e %.2e %.2e, order %.2f\n", law.name, apart[0], apart[1],
                apart[2], order);
    EXPECT_LT(apart[2], 0.01) << law.name;
    EXPECT_GE(order, 0.9) << law.name;
  }
}

}  // namespace
}  // namespace trocar
