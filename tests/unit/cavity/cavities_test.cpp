#include "cavity/network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/body.hpp"
#include "support/cavity.hpp"

namespace trocar::cavity {
namespace {

constexpr double V0 = 1e-6;

/// The voids of one cell each around x = 1.5 and 3.5 cm, with their walls.
bool in_void(const Vec3& x, double at)
{
  return (x - Vec3(at, 0.015, 0.015)).cwiseAbs().maxCoeff() < 0.0051;
}

/// Two cavities of 1 cm³ with a tube between them, in a block on all ranks.
struct Scene
{
  explicit Scene(Model model = Model::follower)
      : body({5, 3, 3, Vec3(0.05, 0.03, 0.03), 0.0,
              [](const Vec3& x) { return in_void(x, 0.015) || in_void(x, 0.035); }}),
        mesh(body.mesh)
  {
    test::add_surface(mesh, "left", [](const Vec3& x) { return in_void(x, 0.015); });
    test::add_surface(mesh, "right", [](const Vec3& x) { return in_void(x, 0.035); });
    for (const char* name : {"left", "right"}) {
      CavitySettings one;
      one.name = one.surface = name;
      one.model = model;
      settings.cavities.push_back(one);
    }
    ConduitSettings tube;
    tube.name = "tube";
    tube.from = 0;
    tube.to = 1;
    tube.resistance = 1e9;
    settings.conduits = {tube};
  }
  Cavities cavities() { return {mesh, body.space, settings, ledger}; }
  OwnedField stretched(const Vec3& by) const
  {
    return test::nodal(body, [=](const Vec3& X) { return Vec3(by.cwiseProduct(X)); });
  }

  test::Body body;
  mesh::Mesh mesh;
  Settings settings;
  core::Ledger ledger;
};

TEST(Pressure, PulsesAboutItsMeanAndIsScaledByItsCurve)
{
  PressureCurve pulse;
  pulse.mean = 100.0;
  pulse.amplitude = 20.0;
  pulse.period = 0.8;
  EXPECT_NEAR(pulse.at(0.0), 100.0, 1e-12);
  EXPECT_NEAR(pulse.at(0.2), 120.0, 1e-12);
  EXPECT_NEAR(pulse.at(0.6), 80.0, 1e-12);
  pulse.curve = core::parse_csv("time,factor\n0,0\n0.4,1\n", "ramp.csv");
  EXPECT_NEAR(pulse.at(0.2), 60.0, 1e-12);
}

// On every rank: volumes of walls whose nodes other ranks own.
TEST(CavityVolumes, FollowTheWall)
{
  Scene scene;
  const Cavities cavities = scene.cavities();
  const Vec3 by(0.1, -0.2, 0.3);
  const VecX volumes = cavities.volumes(cavities.shape(scene.stretched(by)));
  for (int i : {0, 1}) {
    EXPECT_NEAR(cavities.wall(i).volume(), V0, 1e-12 * V0);
    EXPECT_NEAR(volumes[i], V0 * 1.1 * 0.8 * 1.3, 1e-12 * V0);
  }
}

// A curve scales the fluid there was at the start; what has leaked is not scaled with it.
TEST(CavityAmount, FollowsItsCurveInAnyNumberOfSteps)
{
  Scene scene;
  scene.settings.cavities[0].volume_curve =
      core::parse_csv("time,factor\n0,1\n1,2\n2,0.5\n", "curve.csv");
  const Cavities cavities = scene.cavities();
  const OwnedField u = scene.body.space.zero();
  State state = start(cavities);
  state.cavity[0].amount -= 0.1 * V0;
  double before = 0.0;
  for (double t : {0.5, 1.0, 1.5, 2.0}) {
    state = advance(cavities, state, {before, t, {}}, u);
    before = t;
    const double factor = t <= 1.0 ? 1.0 + t : 3.5 - 1.5 * t;
    EXPECT_NEAR(state.cavity[0].amount, (factor - 0.1) * V0, 1e-12 * V0) << t;
    EXPECT_NEAR(state.cavity[1].amount, V0, 1e-12 * V0);
  }
}

// A closed wall under one pressure has no resultant; the forces work as p dV does.
TEST(CavityForces, PushTheTissueAwayFromTheFluid)
{
  for (Model model : {Model::frozen, Model::follower}) {
    Scene scene(model);
    const Cavities cavities = scene.cavities();
    State state = start(cavities);
    state.cavity[0].pressure = 500.0;
    const OwnedField u = scene.body.space.zero();
    const OwnedField f = cavities.forces(state, cavities.shape(u), {0.1, 0.1, false});
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < scene.body.space.owned(); ++i) sum += f.node(i);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(scene.body.comm.sum(sum[a]), 0.0, 1e-15 * 500.0);
    const double growth = 1e-3;  // dV = 3 V dx/x
    const OwnedField d = scene.stretched(Vec3::Constant(growth));
    EXPECT_NEAR(scene.body.space.dot(f, d), 500.0 * 3.0 * growth * V0, 1e-12 * 500.0 * V0);
  }
}

TEST(CavityForces, OfTheFluidsWeightAreItsWeight)
{
  Scene scene;
  scene.settings.cavities[1].weight = Vec3(0.0, 0.0, -9810.0);
  const Cavities cavities = scene.cavities();
  const fem::Load load =
      cavities.load(start(cavities), cavities.shape(scene.body.space.zero()), {0, 1, true});
  ASSERT_EQ(load.force.value.size(), scene.body.space.owned_dofs());
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < scene.body.space.owned(); ++i) sum += load.force.node(i);
  EXPECT_NEAR(scene.body.comm.sum(sum.z()), -9810.0 * V0, 1e-12 * 9810.0 * V0);
  EXPECT_NEAR(scene.body.comm.sum(sum.x()), 0.0, 1e-12 * 9810.0 * V0);
}

// The stiffness of a follower load is the derivative of its forces.
TEST(CavityForces, OfAFollowerTurnWithTheWall)
{
  Scene scene;
  scene.settings.cavities[0].fluid.kind = law::FluidLaw::Kind::pressure;
  scene.settings.cavities[0].pressure.mean = 300.0;
  scene.settings.cavities[1].weight = Vec3(500.0, 0.0, -9810.0);
  const Cavities cavities = scene.cavities();
  const State state = start(cavities);
  const core::TimeStep now{0.1, 0.1, false};
  const OwnedField u = scene.stretched(Vec3(0.1, 0.05, -0.1));
  const OwnedField d = test::nodal(scene.body, [](const Vec3& X) {
    return Vec3(std::sin(100.0 * X.y()), std::cos(80.0 * X.z()), std::sin(90.0 * X.x()));
  });
  const double step = 1e-6;
  const auto force = [&](double s) {
    const OwnedField there{u.value + s * d.value};
    return cavities.load(state, cavities.shape(there), now).force.value;
  };
  const core::VecX difference = (force(step) - force(-step)) / (2.0 * step);
  const fem::Load load = cavities.load(state, cavities.shape(u), now);
  ASSERT_TRUE(load.stiffness);
  const OwnedField product = load.stiffness(d);
  EXPECT_LT(scene.body.space.norm({product.value - difference}),
            1e-8 * scene.body.space.norm(product));
}

// What leaves one cavity within a step arrives in the other, and the tube tells.
TEST(CavityNetwork, MovesFluidFromHighPressureToLow)
{
  Scene scene;
  const Cavities cavities = scene.cavities();
  State state = start(cavities);
  const core::TimeStep now{0.2, 0.1, false};
  const core::VecX p = Eigen::Vector2d(300.0, -100.0);
  const Fluid fluid = cavity::fluid(cavities, state, p, now);
  const double moved = 0.1 * 400.0 / 1e9;
  EXPECT_NEAR(fluid.volume[0], V0 - moved, 1e-13 * V0);
  EXPECT_NEAR(fluid.volume[1], V0 + moved, 1e-13 * V0);
  EXPECT_NEAR(fluid.compliance(0, 0), 0.1 / 1e9, 1e-24);
  EXPECT_NEAR(fluid.compliance(0, 1), -0.1 / 1e9, 1e-24);
  state.cavity[0].pressure = p[0];
  state.cavity[1].pressure = p[1];
  const OwnedField u = scene.body.space.zero();
  const auto reports = accept(cavities, {u, cavities.shape(u), now}, state);
  EXPECT_NEAR(state.conduit[0].flow, 400.0 / 1e9, 1e-20);
  EXPECT_NEAR(state.conduit[0].moved, moved, 1e-20);
  EXPECT_NEAR(state.cavity[0].amount, V0 - moved, 1e-13 * V0);
  EXPECT_NEAR(state.cavity[1].amount, V0 + moved, 1e-13 * V0);
  EXPECT_NEAR(reports[0].error, moved / V0, 1e-12);  // the wall has not followed
}

// Poiseuille's laws: π r h³/(6 μ L) between the needle and its channel, π r⁴/(8 μ L) through the
// hole it leaves.
TEST(CavityNetwork, FlowsAlongTheNeedleAndThroughItsHole)
{
  Scene scene;
  ConduitSettings& conduit = scene.settings.conduits[0];
  conduit.resistance = 0.0;
  conduit.needle = 0;
  conduit.needle_radius = 0.0006;
  conduit.gap = 1e-4;
  conduit.hole_radius = 0.0003;
  conduit.viscosity = 2e-3;
  conduit.length = 0.02;
  const Cavities cavities = scene.cavities();
  State state = start(cavities);
  const double h = 0.1, drop = 400.0, pi = std::numbers::pi;
  const core::VecX p = Eigen::Vector2d(300.0, -100.0);
  const auto flow = [&](bool needle_in, bool pierced) {
    state.conduit[0].needle_in = needle_in;
    state.conduit[0].pierced = pierced;
    return (V0 - cavity::fluid(cavities, state, p, {h, h, false}).volume[0]) / h;
  };
  const double along = pi * 0.0006 * 1e-12 / (6.0 * 2e-3 * 0.02) * drop;
  const double through = pi * std::pow(0.0003, 4) / (8.0 * 2e-3 * 0.02) * drop;
  EXPECT_NEAR(flow(true, true), along, 1e-9 * along);
  EXPECT_NEAR(flow(false, true), through, 1e-9 * through);
  EXPECT_NEAR(flow(false, false), 0.0, 1e-9 * through);
}

// An alarm is of how far the pressure has moved since the start, up or down.
TEST(CavityAlarm, TellsOfAChangeOfPressure)
{
  Scene scene;
  scene.settings.conduits.clear();
  scene.settings.cavities[0].alarm = 300.0;
  const Cavities cavities = scene.cavities();
  State state = start(cavities);
  const OwnedField u = scene.body.space.zero();
  const auto alarm = [&](double pressure, const core::TimeStep& now) {
    state.cavity[0].pressure = pressure;
    return accept(cavities, {u, cavities.shape(u), now}, state)[0].alarm;
  };
  EXPECT_FALSE(alarm(1000.0, core::TimeStep::at_start(0.1)));
  EXPECT_FALSE(alarm(1299.0, {0.1, 0.1, false}));
  EXPECT_TRUE(alarm(1301.0, {0.2, 0.1, false}));
  EXPECT_FALSE(alarm(701.0, {0.3, 0.1, false}));
  EXPECT_TRUE(alarm(699.0, {0.4, 0.1, false}));
}

// The tip in the second void opens the conduit; its channel is kept when the needle has gone.
TEST(CavityNetwork, AnEdgeOpensWhenItsNeedleIsInEveryCavityItJoins)
{
  Scene scene;
  scene.settings.conduits[0].needle = 0;
  const Cavities cavities = scene.cavities();
  const OwnedField u = scene.body.space.zero();
  const VoidPiece left{Vec3(0.015, 0.015, 0.015), 0.01}, right{Vec3(0.035, 0.015, 0.015), 0.02};
  const State outside = advance(cavities, start(cavities), {0.0, 0.1, {{}}}, u);
  EXPECT_FALSE(outside.conduit[0].needle_in || outside.conduit[0].pierced);
  const State half = advance(cavities, outside, {0.1, 0.2, {{left}}}, u);
  EXPECT_FALSE(half.conduit[0].needle_in || half.conduit[0].pierced);
  const State through = advance(cavities, half, {0.2, 0.3, {{left, right}}}, u);
  EXPECT_TRUE(through.conduit[0].needle_in && through.conduit[0].pierced);
  EXPECT_EQ(through.conduit[0].channel, 0.02);
  const State gone = advance(cavities, through, {0.3, 0.4, {{}}}, u);
  EXPECT_FALSE(gone.conduit[0].needle_in);
  EXPECT_TRUE(gone.conduit[0].pierced);
  EXPECT_EQ(gone.conduit[0].channel, 0.02);
}

TEST(CavityWalls, BelongToOneCavityEach)
{
  Scene scene;
  scene.settings.cavities[1].surface = "left";
  try {
    scene.cavities();
    ADD_FAILURE() << "two cavities behind one wall";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::options);
    EXPECT_NE(std::string(failure.what()).find("'left' and 'right'"), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::cavity
