#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "support/body.hpp"
#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using core::MatX;
using core::Vec3;
using core::VecX;

/// A plate bonded to the top that presses by this part of the block's height.
void press(driver::Scenario& scenario, double depth)
{
  scenario.tissue.boundary.displacements = {{"z1", Vec3(0.0, 0.0, -depth), std::nullopt}};
}

driver::StepResult solved(driver::Simulation& simulation)
{
  driver::StepResult result = simulation.initial_state();
  if (!result.state) throw core::solver_error(result.why);
  return result;
}

driver::StepReport solved(const driver::Scenario& scenario)
{
  driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  return solved(simulation).report;
}

/// Everything dense and serial, written anew: K, the wall, and Newton's method on (u, p).
struct Dense
{
  explicit Dense(const driver::Scenario& scenario)
      : mesh(scenario.mesh),
        wall(mesh, "wall", false),
        K(test::dense_operator(mesh, scenario.tissue.materials[0], 1.0, 0.0)),
        u(VecX::Zero(K.rows()))
  {
    for (const auto& tool : scenario.tissue.boundary.displacements)
      for (int node : mesh::group_nodes(mesh, tool.group)) u.segment<3>(3 * node) = tool.value;
    for (int node = 0; node < mesh.node_count(); ++node) {
      const double z = mesh.x[std::size_t(node)].z();
      const bool held = z == 0.0 || z == height;
      for (int a = 0; a < 3; ++a)
        if (!held) free.push_back(3 * node + a);
    }
  }

  VecX wall_of(const VecX& field) const
  {
    VecX values(3 * Eigen::Index(wall.nodes().size()));
    for (std::size_t i = 0; i < wall.nodes().size(); ++i)
      values.segment<3>(3 * Eigen::Index(i)) = field.segment<3>(3 * wall.nodes()[i]);
    return values;
  }
  VecX nodal(const VecX& values) const
  {
    VecX field = VecX::Zero(K.rows());
    for (std::size_t i = 0; i < wall.nodes().size(); ++i)
      field.segment<3>(3 * wall.nodes()[i]) = values.segment<3>(3 * Eigen::Index(i));
    return field;
  }

  /// Newton for the follower model; the load p g(u) and the volume V(u) = V_0.
  void follow()
  {
    const auto n = Eigen::Index(free.size());
    for (int iteration = 0; iteration < 20; ++iteration) {
      const VecX x = wall.undeformed() + wall_of(u);
      const VecX g = nodal(law::volume_gradient(wall.surface(), x));
      MatX T = MatX::Zero(n + 1, n + 1);
      MatX H(K.rows(), K.cols());
      for (Eigen::Index j = 0; j < K.cols(); ++j)
        H.col(j) =
            nodal(law::volume_hessian_times(wall.surface(), x, wall_of(VecX::Unit(K.rows(), j))));
      T.topLeftCorner(n, n) = (K - p * H)(free, free);
      T.col(n).head(n) = -g(free);
      T.row(n).head(n) = -g(free).transpose();
      VecX r(n + 1);
      r.head(n) = (p * g - K * u)(free);
      r[n] = law::volume(wall.surface(), x) - wall.volume();
      const VecX d = T.partialPivLu().solve(r);
      u(free) += d.head(n);
      p += d[n];
      if (d.head(n).norm() < 1e-15 * u.norm()) break;
    }
  }

  static constexpr double height = 0.05;
  const mesh::Mesh& mesh;
  cavity::Wall wall;
  MatX K;
  VecX u;
  double p = 0.0;
  std::vector<Eigen::Index> free;
};

// The whole program against a dense Newton method written for this test.
TEST(Follower, AgreesWithDenseNewton)
{
  driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
  press(scenario, 0.006);  // 12 %
  const base::Comm comm(MPI_COMM_WORLD);
  driver::Simulation simulation(scenario, comm);
  const driver::StepResult result = solved(simulation);
  Dense dense(scenario);
  dense.follow();
  const fem::GlobalField u = simulation.space().gather(result.state->tissue.u);
  EXPECT_LT((u.value - dense.u).norm(), 1e-9 * dense.u.norm());
  const cavity::CavityReport& report = result.report.cavities[0];
  EXPECT_NEAR(report.pressure, dense.p, 1e-9 * dense.p);
  EXPECT_LE(report.error, 1e-12);
  EXPECT_LE(result.report.linearisations, 5);  // Newton, cold
  // Reaction of the plate: K u less nothing, for the pressure does not act there.
  const VecX forces = dense.K * dense.u;
  Vec3 plate = Vec3::Zero();
  for (int node : mesh::group_nodes(scenario.mesh, "z1")) plate += forces.segment<3>(3 * node);
  EXPECT_LT((result.report.tools[0] - plate).norm(), 1e-8 * plate.norm());
}

// The three solvers of the frozen model find the same root; the linear model keeps the linear
// volume and misses the exact one by the square of the strain.
TEST(Models, FrozenSolversAgreeAndLinearIsOff)
{
  cavity::CavityReport exact;
  for (Solver solver : {Solver::exact, Solver::newton, Solver::proportional}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, Model::frozen, solver);
    press(scenario, 0.004);
    const driver::StepReport report = solved(scenario);
    const cavity::CavityReport& one = report.cavities[0];
    EXPECT_LE(one.error, 1e-12);
    if (solver == Solver::exact) {
      exact = one;
      EXPECT_EQ(report.pressure_updates, 1);
    }
    EXPECT_NEAR(one.pressure, exact.pressure, 1e-9 * exact.pressure);
    if (solver == Solver::newton) {
      EXPECT_LE(report.pressure_updates, 5);
    }
    if (solver == Solver::proportional) {
      EXPECT_GT(report.pressure_updates, 5);
    }
  }
  std::vector<double> error;
  for (double depth : {0.002, 0.001}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, Model::linear);
    press(scenario, depth);
    const driver::StepReport report = solved(scenario);
    EXPECT_EQ(report.linearisations, 1);
    error.push_back(report.cavities[0].error);
  }
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.3);
}

// Every law: what the wall holds is what the fluid takes at its pressure.
TEST(Laws, VolumeOfTheWallIsThatOfTheFluid)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower})
    for (auto kind :
         {law::FluidLaw::Kind::bulk, law::FluidLaw::Kind::gas, law::FluidLaw::Kind::table}) {
      driver::Scenario scenario = test::cavity_scenario(5, 3, model, Solver::exact);
      press(scenario, 0.004);
      cavity::CavitySettings& one = scenario.cavities.cavities[0];
      one.fluid.kind = kind;
      one.fluid.bulk_modulus = 3e4;
      one.fluid.ambient = 2e4;
      one.fluid.table =
          law::MonotoneSpline({-1e3, 0, 500, 1e3, 4e3}, {3e-5, 2.7e-5, 2.69e-5, 2.6e-5, 2e-5});
      driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
      const driver::StepResult result = solved(simulation);
      const cavity::CavityReport& report = result.report.cavities[0];
      const double V0 = simulation.cavities()->wall(0).volume();
      const double fluid = one.fluid.at(report.pressure, V0, 0.0).volume;
      EXPECT_GT(report.pressure, 100.0);
      EXPECT_LT(fluid, V0);
      if (model == Model::linear)
        EXPECT_NEAR(report.volume, fluid, 0.02 * V0);
      else
        EXPECT_NEAR(report.volume, fluid, 2e-12 * V0);
    }
}

// Corotational tissue with a follower cavity: the same with a factor in every step and with old
// factors, in time and along a path.
TEST(Corotational, OldFactorsGiveTheSame)
{
  for (bool dynamic : {false, true}) {
    std::vector<double> pressure;
    for (double lag : {0.0, 1e-9}) {
      driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
      scenario.tissue.model = tissue::Model::corotational;
      scenario.tissue.lag_tolerance = lag;
      if (dynamic) scenario.time.analysis = driver::Analysis::dynamic;
      scenario.time.step = 0.05;
      scenario.time.end = 0.2;
      press(scenario, 0.008);
      scenario.tissue.boundary.displacements[0].curve =
          core::parse_csv("time,factor\n0,0\n0.2,1\n", "test");
      const test::Run run = test::run(scenario);
      pressure.push_back(run.reports.back().cavities[0].pressure);
      EXPECT_LE(run.reports.back().cavities[0].error, 1e-12);
    }
    EXPECT_GT(pressure[0], 100.0);
    EXPECT_NEAR(pressure[1], pressure[0], 1e-6 * pressure[0]);
  }
}

// A given pressure opens the cavity as far as volume control says, in every tissue, at the start of
// a static or a dynamic run; a fluid enclosed at that pressure then stays as it is.
TEST(GivenPressure, IsTheInverseOfVolumeControl)
{
  for (tissue::Model tissue : {tissue::Model::linear, tissue::Model::corotational})
    for (double part : {0.9, 1.001, 1.1}) {
      driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
      scenario.tissue.model = tissue;
      scenario.tissue.lag_tolerance = 1e-8;
      driver::Scenario volume = scenario, pressure = scenario, enclosed = scenario;
      volume.cavities.cavities[0].volume = part * 2.7e-5;
      const cavity::CavityReport held = solved(volume).cavities[0];
      pressure.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::pressure;
      pressure.cavities.cavities[0].pressure.mean = held.pressure;
      EXPECT_NEAR(solved(pressure).cavities[0].volume, part * 2.7e-5, 1e-7 * 2.7e-5);
      enclosed.cavities.cavities[0].initial_pressure = held.pressure;
      enclosed.time.analysis = driver::Analysis::dynamic;
      enclosed.time.start_in_equilibrium = true;
      enclosed.time.step = 0.02;
      enclosed.time.end = 0.1;
      const test::Run run = test::run(enclosed);
      EXPECT_NEAR(run.reports.front().cavities[0].volume, part * 2.7e-5, 1e-7 * 2.7e-5);
      EXPECT_NEAR(run.reports.back().cavities[0].pressure, held.pressure,
                  1e-5 * std::abs(held.pressure));
    }
}

/// dV/dp of a cavity at rest [m³/Pa].
double compliance(driver::Scenario scenario)
{
  cavity::CavitySettings& one = scenario.cavities.cavities[0];
  scenario.tissue.boundary.displacements.clear();
  scenario.time.end = 0.0;
  scenario.time.analysis = driver::Analysis::equilibrium;
  scenario.cavities.edges.clear();
  for (cavity::CavitySettings& any : scenario.cavities.cavities) any.initial_pressure.reset();
  one.fluid.kind = law::FluidLaw::Kind::pressure;
  one.pressure.mean = 1e-3;
  driver::Simulation simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const driver::StepReport report = solved(simulation).report;
  return (report.cavities[0].volume - simulation.cavities()->wall(0).volume()) / 1e-3;
}

// A leak: p falls as backward Euler has it, p_0/(1 + h/RC)^n, which is exp(-t/RC) to first order;
// what left the cavity is what came out of the leak.
TEST(Network, LeakDecays)
{
  std::vector<double> error;
  for (int steps : {20, 40}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, Model::linear);
    const double C = compliance(scenario);
    const double tau = 0.5;
    scenario.cavities.cavities[0].initial_pressure = 2000.0;
    cavity::EdgeSettings leak;
    leak.name = "leak";
    leak.from = 0;
    leak.resistance = tau / C;
    scenario.cavities.edges = {leak};
    scenario.time.end = 1.0;
    scenario.time.step = 1.0 / steps;
    const test::Run run = test::run(scenario);
    const double h = scenario.time.step;
    for (int n = 0; n <= steps; ++n)
      EXPECT_NEAR(run.reports[static_cast<std::size_t>(n)].cavities[0].pressure,
                  2000.0 / std::pow(1.0 + h / tau, n), 1e-8 * 2000.0);
    error.push_back(run.reports.back().cavities[0].pressure / 2000.0 - std::exp(-1.0 / tau));
    // A linear cavity's volume is V_0 + C p.
    EXPECT_NEAR(run.states.back().cavities.edge[0].moved,
                C * (2000.0 - run.reports.back().cavities[0].pressure), 1e-7 * C * 2000.0);
  }
  EXPECT_NEAR(error[0] / error[1], 2.0, 0.1);
}

// Two equal cavities far from each other: their pressures meet with τ = RC/2. Exact volumes: what
// leaves one arrives in the other.
TEST(Network, TwoCavitiesMeet)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    driver::Scenario scenario = test::cavity_scenario(5, 1, model, Solver::exact);
    test::BlockShape shape{11, 5, 5, Vec3(0.11, 0.05, 0.05)};
    const auto in = [](const Vec3& x, double at) {
      return (x - Vec3(at, 0.025, 0.025)).cwiseAbs().maxCoeff() < 0.0051;
    };
    shape.hole = [&](const Vec3& x) { return in(x, 0.025) || in(x, 0.085); };
    scenario.mesh = test::block(shape);
    test::add_surface(scenario.mesh, "wall", [&](const Vec3& x) { return in(x, 0.025); });
    test::add_surface(scenario.mesh, "other", [&](const Vec3& x) { return in(x, 0.085); });
    cavity::CavitySettings other = scenario.cavities.cavities[0];
    other.name = "other";
    other.surface = "other";
    scenario.cavities.cavities.push_back(other);
    scenario.cavities.cavities[0].initial_pressure = 100.0;
    scenario.cavities.cavities[1].initial_pressure = -100.0;
    driver::Scenario alone = scenario;
    const double C = compliance(alone);
    cavity::EdgeSettings tube;
    tube.name = "tube";
    tube.from = 0;
    tube.to = 1;
    tube.resistance = 1.0 / C;
    scenario.cavities.edges = {tube};
    scenario.time.end = 0.5;
    scenario.time.step = 0.05;
    const test::Run run = test::run(scenario);
    const auto& last = run.reports.back().cavities;
    const double fallen = std::pow(1.0 + 0.05 * 2.0, -10);
    EXPECT_NEAR((last[0].pressure - last[1].pressure) / 200.0, fallen, 0.02 * fallen);
    const auto& first = run.reports.front().cavities;
    const double moved = run.states.back().cavities.edge[0].moved;
    if (model != Model::linear) {
      const double V0 = 1e-6;
      EXPECT_NEAR(first[0].volume - last[0].volume, moved, 3e-12 * V0);
      EXPECT_NEAR(last[1].volume - first[1].volume, moved, 3e-12 * V0);
    }
  }
}

// Injection: the volume grows by what is pumped in, whatever the pressure does.
TEST(Network, InjectionIsKept)
{
  for (Model model : {Model::frozen, Model::follower}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    cavity::EdgeSettings pump;
    pump.name = "pump";
    pump.to = 0;
    pump.flow = 2e-6;
    pump.flow_curve = core::parse_csv("time,factor\n0,0\n1,1\n2,0\n", "test");
    scenario.cavities.edges = {pump};
    scenario.time.step = 0.25;
    scenario.time.end = 2.0;
    const test::Run run = test::run(scenario);
    // Sum of backward Euler: 0.25 s · (0.25 + 0.5 + 0.75 + 1 + 0.75 + 0.5 + 0.25) = 1 s.
    EXPECT_NEAR(run.states.back().cavities.edge[0].moved, 2e-6, 1e-18);
    EXPECT_NEAR(run.reports.back().cavities[0].volume - run.reports.front().cavities[0].volume,
                2e-6, 1e-11 * 2.7e-5);
    EXPECT_GT(run.reports.back().cavities[0].pressure, 100.0);
  }
}

// A valve lets fluid out and none in; gas and valve are laws that the dense problem settles.
TEST(Network, ValveAndGas)
{
  driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
  scenario.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::gas;
  scenario.cavities.cavities[0].fluid.ambient = 1e4;
  cavity::EdgeSettings valve;
  valve.name = "valve";
  valve.from = 0;
  valve.resistance = 1e9;
  valve.valve = true;
  scenario.cavities.edges = {valve};
  scenario.time.step = 0.1;
  scenario.time.end = 2.0;
  press(scenario, 0.004);
  scenario.tissue.boundary.displacements[0].curve =
      core::parse_csv("time,factor\n0,0\n1,1\n2,-0.5\n", "test");
  const test::Run run = test::run(scenario);
  double moved = 0.0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double now = run.states[n].cavities.edge[0].moved;
    EXPECT_GE(now, moved);
    const double p = run.reports[n].cavities[0].pressure;
    EXPECT_NEAR(run.states[n].cavities.edge[0].flow, std::max(p, 0.0) / 1e9,
                1e-9 * std::abs(p) / 1e9);
    moved = now;
  }
  EXPECT_GT(moved, 0.0);
  EXPECT_LT(run.reports.back().cavities[0].pressure, 0.0);
}

// The fluid's weight rests on its wall, ρ g V in all, and the support below carries it.
TEST(Gravity, WeightOfTheFluidArrives)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    scenario.tissue.boundary.fixed.clear();
    scenario.tissue.boundary.displacements = {{"z0", Vec3::Zero(), std::nullopt}};
    scenario.cavities.cavities[0].weight = Vec3(0.0, 0.0, -9810.0);
    const driver::StepReport report = solved(scenario);
    // Only a follower's weight is that of the deformed cavity; of constant volume they are the
    // same.
    const double weight = 9810.0 * 2.7e-5;
    EXPECT_NEAR(report.tools[0].z(), weight, 1e-6 * weight);
    EXPECT_NEAR(report.tools[0].x(), 0.0, 1e-6 * weight);
  }
}

/// A rigid needle with friction straight through the block beside the cavity, or into it.
void add_needle(driver::Scenario& scenario, double y)
{
  driver::Scenario with = test::needle_scenario({});
  scenario.needles = with.needles;
  scenario.needles[0].motion.entry = Vec3(0.0, y, 0.0273);
  scenario.insertion = with.insertion;
  scenario.tissue.materials[0].rayleigh_stiffness = 0.02;
  scenario.time.analysis = driver::Analysis::dynamic;
  scenario.time.step = 0.02;
  scenario.time.end = 1.0;
}

// Beside a needle the three models agree for small deformation, and volumes are kept.
TEST(WithNeedle, ModelsAgree)
{
  std::vector<double> pressure;
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    add_needle(scenario, 0.0053);
    scenario.insertion.friction = test::same({0.5, 0.4, 0.0});
    scenario.time.end = 0.5;
    const test::Run run = test::run(scenario);
    const auto& report = run.reports.back();
    pressure.push_back(report.cavities[0].pressure);
    EXPECT_GT(report.rows, 3);
    if (model != Model::linear) {
      EXPECT_LE(report.cavities[0].error, 1e-12);
    }
  }
  EXPECT_GT(std::abs(pressure[0]), 0.1);
  EXPECT_NEAR(pressure[1], pressure[0], 0.02 * std::abs(pressure[0]));
  EXPECT_NEAR(pressure[2], pressure[0], 0.02 * std::abs(pressure[0]));
}

// The tip comes through the wall: the leak opens, pressure and volume fall, no rows in the void;
// after withdrawal the hole goes on leaking with its own resistance.
TEST(Puncture, OpensTheEdge)
{
  driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
  add_needle(scenario, 0.0253);
  scenario.time.end = 2.4;
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.velocity = 0.02;
  motion.depth = 0.025;
  motion.hold = 0.2;
  motion.withdraw_velocity = 0.03;
  scenario.cavities.cavities[0].initial_pressure = 1000.0;
  scenario.cavities.cavities[0].alarm = 300.0;
  scenario.time.start_in_equilibrium = true;
  cavity::EdgeSettings leak;
  leak.name = "leak";
  leak.from = 0;
  leak.needle = 0;
  leak.needle_radius = 0.0005;
  leak.gap = 2e-4;
  leak.hole_resistance = 1e8;
  scenario.cavities.edges = {leak};
  const test::Run run = test::run(scenario);
  const double V0 = 2.7e-5;
  bool was_in = false, was_out = false, alarmed = false;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const cavity::EdgeState& edge = run.states[n].cavities.edge[0];
    const double p = run.reports[n].cavities[0].pressure;
    const double first = run.reports[0].cavities[0].volume;
    EXPECT_NEAR(first - run.reports[n].cavities[0].volume, edge.moved, 2e-12 * V0);
    if (!edge.pierced) {
      EXPECT_EQ(edge.flow, 0.0);
      continue;
    }
    const double gap = 6.0 * 1e-3 * edge.channel / (std::acos(-1.0) * 0.0005 * std::pow(2e-4, 3));
    EXPECT_NEAR(edge.channel, 0.01, 0.002);
    EXPECT_NEAR(edge.flow, p / (edge.needle_in ? gap : 1e8), 1e-9 * edge.flow);
    was_in = was_in || edge.needle_in;
    was_out = was_out || (was_in && !edge.needle_in);
    alarmed = alarmed || run.reports[n].cavities[0].alarm;
    // In the void the shaft holds nothing: points stand in the first centimetre only.
    for (const auto& point : run.states[n].insertions[0].points)
      EXPECT_LT(run.states[n].insertions[0].path.sites[static_cast<std::size_t>(point.site)].arc,
                0.0101);
  }
  EXPECT_TRUE(was_in && was_out && alarmed);
  EXPECT_LT(run.reports.back().cavities[0].pressure, 600.0);
}

// A needle that is through both walls at the start has opened its edge.
TEST(Puncture, NeedleThroughTheCavityAtTheStart)
{
  driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
  add_needle(scenario, 0.0253);
  scenario.needles[0].motion.inserted = 0.045;
  scenario.needles[0].motion.velocity = 0.0;
  scenario.needles[0].motion.length = 0.1;
  scenario.time.end = 0.04;
  scenario.time.start_in_equilibrium = true;
  scenario.cavities.cavities[0].initial_pressure = 500.0;
  cavity::EdgeSettings leak;
  leak.name = "leak";
  leak.from = 0;
  leak.needle = 0;
  leak.resistance = 1e9;
  scenario.cavities.edges = {leak};
  const test::Run run = test::run(scenario);
  EXPECT_TRUE(run.states.back().cavities.edge[0].needle_in);
  EXPECT_NEAR(run.states.back().cavities.edge[0].channel, 0.01, 1e-3);
  EXPECT_GT(run.states.back().cavities.edge[0].flow, 0.0);
}

// Two cavities in a row: an edge between them opens when the needle has come into the second one.
TEST(Puncture, ASeptumHoldsUntilItIsPierced)
{
  driver::Scenario scenario = test::cavity_scenario(5, 1, Model::linear);
  test::BlockShape shape{7, 5, 5, Vec3(0.07, 0.05, 0.05)};
  const auto in = [](const Vec3& x, double at) {
    return (x - Vec3(at, 0.025, 0.025)).cwiseAbs().maxCoeff() < 0.0051;
  };
  shape.hole = [&](const Vec3& x) { return in(x, 0.015) || in(x, 0.045); };
  scenario.mesh = test::block(shape);
  test::add_surface(scenario.mesh, "wall", [&](const Vec3& x) { return in(x, 0.015); });
  test::add_surface(scenario.mesh, "other", [&](const Vec3& x) { return in(x, 0.045); });
  cavity::CavitySettings other = scenario.cavities.cavities[0];
  other.name = other.surface = "other";
  scenario.cavities.cavities.push_back(other);
  add_needle(scenario, 0.0253);
  scenario.needles[0].motion.entry.z() = 0.0243;
  scenario.needles[0].motion.velocity = 0.05;
  scenario.needles[0].motion.depth = 0.045;
  scenario.needles[0].motion.length = 0.12;
  cavity::EdgeSettings bridge;
  bridge.name = "bridge";
  bridge.from = 0;
  bridge.to = 1;
  bridge.needle = 0;
  bridge.resistance = 1e9;
  scenario.cavities.edges = {bridge};
  const test::Run run = test::run(scenario);
  bool opened = false;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double depth = run.states[n].needles[0].shaft.tip().x();
    const bool pierced = run.states[n].cavities.edge[0].pierced;
    if (depth < 0.039) {
      EXPECT_FALSE(pierced) << depth;
    }
    opened = opened || pierced;
  }
  EXPECT_TRUE(opened);
}

/// A plate on the top, moved by two curves: down along z, sideways along x.
driver::Scenario moved_plate(Model model, const std::string& down, const std::string& sideways)
{
  constexpr double open = std::numeric_limits<double>::quiet_NaN();
  driver::Scenario scenario = test::cavity_scenario(5, 3, model, Solver::exact);
  scenario.time.step = 1.0;
  scenario.tissue.boundary.displacements = {
      {"z1", Vec3(open, 0.0, -0.006), core::parse_csv("time,factor\n" + down, "down")},
      {"z1", Vec3(0.006, open, open), core::parse_csv("time,factor\n" + sideways, "sideways")}};
  return scenario;
}

/// Work of the plate round the triangle (0,0), (1,0), (1,1) of its two motions, `n` steps a side.
double loop_work(Model model, int n)
{
  driver::Scenario scenario = moved_plate(model, "0,0\n1,1\n2,1\n3,0\n", "0,0\n1,0\n2,1\n3,0\n");
  scenario.time.step = 1.0 / n;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  double work = 0.0;
  const auto at = [&](int k, std::size_t tool) {
    const auto& one = scenario.tissue.boundary.displacements[tool];
    return 0.006 * core::interpolate(*one.curve, 1, static_cast<double>(k) / n);
  };
  for (int k = 1; k <= 3 * n; ++k) {
    const auto force = [&](std::size_t tool, int axis) {
      return 0.5 * (run.reports[static_cast<std::size_t>(k)].tools[tool][axis] +
                    run.reports[static_cast<std::size_t>(k - 1)].tools[tool][axis]);
    };
    work += -force(0, 2) * (at(k, 0) - at(k - 1, 0)) + force(1, 0) * (at(k, 1) - at(k - 1, 1));
  }
  return work;
}

// The follower model has an energy: round a closed path nothing is gained, but for the sum's own
// error, which falls as h². Frozen loads have none: something stays.
TEST(Energy, ClosedPathOfATool)
{
  const double coarse = loop_work(Model::follower, 4), fine = loop_work(Model::follower, 8);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  const double frozen = loop_work(Model::frozen, 8), finer = loop_work(Model::frozen, 16);
  std::printf("[ closed path ] follower %.3g, %.3g J; frozen %.3g, %.3g J\n", coarse, fine, frozen,
              finer);
  EXPECT_GT(std::abs(finer), 20.0 * std::abs(loop_work(Model::follower, 16)));
}

// Stiffness that a tool feels is symmetric with follower pressures; how far frozen ones are off is
// measured.
TEST(Energy, ToolStiffnessIsSymmetric)
{
  const double d = 0.01;
  for (Model model : {Model::follower, Model::frozen}) {
    const auto force = [&](double down, double sideways) {
      // Twice the same equilibrium: the second one starts from the first and polishes it.
      driver::Scenario scenario = moved_plate(model, "0,0\n1,1\n2,1\n", "0,0\n1,1\n2,1\n");
      scenario.time.end = 2.0;
      scenario.tissue.boundary.displacements[0].value.z() *= down;
      scenario.tissue.boundary.displacements[1].value.x() *= sideways;
      const std::vector<Vec3> tools = test::run(scenario).reports.back().tools;
      return Eigen::Vector2d(-tools[0].z(), tools[1].x());
    };
    const auto slope = [&](const Eigen::Vector2d& way) -> Eigen::Vector2d {
      const auto at = [&](double s) { return force(0.8 + s * way[0], 0.6 + s * way[1]); };
      return (8.0 * (at(d) - at(-d)) - (at(2 * d) - at(-2 * d))) / (12.0 * d);
    };
    const Eigen::Vector2d a = slope({1, 0}), b = slope({0, 1});
    const double asymmetry = std::abs(a[1] - b[0]) / std::max(a.norm(), b.norm());
    std::printf("[ tool stiffness ] %s: across %.6g and %.6g of %.6g N/m, asymmetry %.2g\n",
                model == Model::follower ? "follower" : "frozen", a[1] / 0.006, b[0] / 0.006,
                a.norm() / 0.006, asymmetry);
    if (model == Model::follower) {
      EXPECT_LE(asymmetry, 1e-9);
    } else {
      EXPECT_GT(asymmetry, 1e-5);
    }
  }
}

// A body 3 m from the origin: nothing changes, because walls count from a point of their own.
TEST(FarFromTheOrigin, SamePressure)
{
  std::vector<double> pressure;
  for (double away : {0.0, 3.0}) {
    driver::Scenario scenario = test::cavity_scenario(5, 3, Model::follower);
    press(scenario, 0.005);
    for (Vec3& x : scenario.mesh.x) x += Vec3(away, -away, away);
    const driver::StepReport report = solved(scenario);
    pressure.push_back(report.cavities[0].pressure);
    EXPECT_LE(report.cavities[0].error, 1e-12);
  }
  EXPECT_NEAR(pressure[1], pressure[0], 1e-9 * pressure[0]);
}

}  // namespace
}  // namespace trocar
