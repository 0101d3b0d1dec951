#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "support/cavity.hpp"
#include "support/shell.hpp"

// Cavities against closed forms (docs/verification.md).
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;

constexpr double E = 15000.0, nu = 0.3;
const double G = E / (2.0 * (1.0 + nu)), K = E / (3.0 * (1.0 - 2.0 * nu));

step::Scene statics(mesh::Mesh mesh, cavity::Model model)
{
  return test::fluid_filled(std::move(mesh), {E, nu, 1000.0, 0.0, 0.0}, model);
}

void give_pressure(step::Scene& scenario, double p)
{
  scenario.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::pressure;
  scenario.cavities.cavities[0].pressure.mean = p;
}

/// Prescribes u(X) on the outer surface.
void prescribe(step::Scene& scenario, const std::function<Vec3(const Vec3&)>& u)
{
  tissue::PrescribedDisplacement tool{"outer", Vec3::Zero(), std::nullopt, {}};
  for (int node : mesh::group_nodes(scenario.mesh, "outer"))
    tool.field[node] = u(scenario.mesh.x[static_cast<std::size_t>(node)]);
  scenario.tissue.boundary.displacements = {tool};
}

struct Solved
{
  explicit Solved(const step::Scene& scenario)
      : simulation(scenario, base::Comm(MPI_COMM_WORLD)), result(step::initial_state(simulation))
  {
    if (!result) throw core::solver_error(result.why());
    u = simulation.space.gather(result->state.tissue.u);
  }
  const cavity::CavityReport& report() const { return result->report.cavities[0]; }
  double V0() const { return simulation.cavities->wall(0).volume(); }

  step::Model simulation;
  step::Outcome<step::Accepted> result;
  fem::GlobalField u;
};

double order(double coarse, double fine)
{
  return std::log2(coarse / fine);
}

// Lamé: a shell under inner pressure, its outer surface free. The wall's compliance dV/dp, with the
// volume of the faceted wall to scale with.
TEST(LameShell, ComplianceConverges)
{
  const double a = 0.011, b = 0.025, p = 1.0;
  std::vector<double> error;
  for (int levels : {1, 2, 3}) {
    step::Scene scenario =
        statics(test::shell(levels, 3 << (levels - 1), a, b), cavity::Model::linear);
    scenario.tissue.boundary.fixed = {{"on_x", 6}, {"on_y", 5}, {"on_z", 3}};
    give_pressure(scenario, p);
    const Solved solved(scenario);
    const double u = p * a * a * a / (b * b * b - a * a * a) *
                     ((1.0 - 2.0 * nu) * a / E + b * b * b * (1.0 + nu) / (2.0 * E * a * a));
    const double exact = 3.0 * u / a;
    error.push_back(std::abs((solved.report().volume / solved.V0() - 1.0) / exact - 1.0));
  }
  std::printf("[ Lamé shell ] error of dV/dp %.3g %.3g %.3g\n", error[0], error[1], error[2]);
  EXPECT_GT(order(error[1], error[2]), 1.5);
  EXPECT_LT(error[2], 0.025);
}

// The same of a tube in plane strain: both ends of the wall are holes that caps close.
TEST(LameTube, ComplianceWithCapsConverges)
{
  const double a = 0.01, b = 0.025, p = 1.0;
  std::vector<double> error;
  for (int n : {1, 2, 4}) {
    step::Scene scenario = statics(test::tube(8 * n, n, 3 * n, a, b, 0.008), cavity::Model::linear);
    scenario.tissue.boundary.fixed = {{"ends", 4}, {"on_x", 2}, {"on_y", 1}};
    scenario.cavities.cavities[0].caps = true;
    give_pressure(scenario, p);
    const Solved solved(scenario);
    EXPECT_EQ(solved.simulation.cavities->wall(0).rims().size(), 2u);
    const double u =
        (1.0 + nu) * p * a * a / (E * (b * b - a * a)) * ((1.0 - 2.0 * nu) * a + b * b / a);
    error.push_back(std::abs((solved.report().volume / solved.V0() - 1.0) / (2.0 * u / a) - 1.0));
  }
  std::printf("[ Lamé tube ] error of dV/dp %.3g %.3g %.3g\n", error[0], error[1], error[2]);
  EXPECT_GT(order(error[1], error[2]), 1.5);
  EXPECT_LT(error[2], 0.02);
}

// Incompressible fluid in a shell whose outer surface is moved in by d: p = (3K+4G) b² d/(b³-a³).
TEST(FluidFilledShell, PressureConverges)
{
  const double a = 0.011, b = 0.025, d = 1e-9;
  std::vector<double> error;
  for (int levels : {1, 2, 3}) {
    step::Scene scenario =
        statics(test::shell(levels, 3 << (levels - 1), a, b), cavity::Model::linear);
    prescribe(scenario, [&](const Vec3& X) { return Vec3(-d / b * X); });
    const Solved solved(scenario);
    const double exact = (3.0 * K + 4.0 * G) * b * b * d / (b * b * b - a * a * a);
    error.push_back(std::abs(solved.report().pressure / exact - 1.0));
  }
  std::printf("[ fluid-filled shell ] error of p %.3g %.3g %.3g\n", error[0], error[1], error[2]);
  EXPECT_GT(order(error[1], error[2]), 1.5);
  EXPECT_LT(error[2], 0.03);
}

/// Eshelby's liquid sphere of radius R: displacement outside it under the remote strain e + θ/3 I.
Vec3 liquid_sphere(const Vec3& x, const Mat3& e, double theta, double R)
{
  const double r = x.norm(), C1 = 5.0 * std::pow(R, 3) / (2.0 * (7.0 - 5.0 * nu)),
               C2 = 3.0 * std::pow(R, 5) / (2.0 * (7.0 - 5.0 * nu));
  const Vec3 ex = e * x;
  const double xex = x.dot(ex);
  return ex + C1 * ((2.0 - 4.0 * nu) * ex / std::pow(r, 3) + 3.0 * x * xex / std::pow(r, 5)) +
         C2 * (2.0 * ex / std::pow(r, 5) - 5.0 * x * xex / std::pow(r, 7)) +
         theta / 3.0 * (1.0 - std::pow(R / r, 3)) * x;
}

// With the exact displacements far out: p = -(K + 4G/3) θ, and the cavity becomes an ellipsoid,
// u = k e x with k = 15(1-ν)/(7-5ν).
TEST(LiquidSphere, PressureAndShapeConverge)
{
  const double R = 0.01, b = 0.02, theta = -0.4e-6;
  const Mat3 e = Vec3(2e-6, -1e-6, -1e-6).asDiagonal();
  const double k = 15.0 * (1.0 - nu) / (7.0 - 5.0 * nu);
  std::vector<double> of_p, of_k;
  for (int levels : {2, 3, 4}) {
    step::Scene scenario =
        statics(test::shell(levels, 2 << (levels - 1), R, b), cavity::Model::linear);
    prescribe(scenario, [&](const Vec3& X) { return liquid_sphere(X, e, theta, R); });
    const Solved solved(scenario);
    of_p.push_back(std::abs(solved.report().pressure / (-(K + 4.0 * G / 3.0) * theta) - 1.0));
    double up = 0.0, down = 0.0;  // best k
    for (int node : solved.simulation.cavities->wall(0).nodes()) {
      const Vec3 ex = e * scenario.mesh.x[static_cast<std::size_t>(node)];
      up += ex.dot(Vec3(solved.u.node(node)));
      down += ex.squaredNorm();
    }
    of_k.push_back(std::abs(up / down / k - 1.0));
  }
  std::printf("[ liquid sphere ] errors of p %.3g %.3g %.3g, of k %.3g %.3g %.3g\n", of_p[0],
              of_p[1], of_p[2], of_k[0], of_k[1], of_k[2]);
  EXPECT_GT(order(of_p[1], of_p[2]), 1.5);
  EXPECT_GT(order(of_k[1], of_k[2]), 1.5);
  EXPECT_LT(of_p[2], 0.01);
  EXPECT_LT(of_k[2], 0.01);
}

// A follower sphere in linear tissue, far from everything: p = 4G (l-1)/l², greatest at l = 2.
// Volume control goes past it, pressure control ends there and says so.
TEST(FollowerSphere, LimitPoint)
{
  const double a = 0.01, b = 0.2;
  const auto scenario_of = [&] {
    step::Scene scenario = statics(test::shell(2, 28, a, b), cavity::Model::follower);
    prescribe(scenario, [](const Vec3&) { return Vec3(Vec3::Zero()); });
    scenario.tissue.allow_inversion = true;  // linear tissue, whatever the strain
    return scenario;
  };
  std::vector<double> p;
  for (double l : {1.2, 2.0, 2.3}) {
    step::Scene scenario = scenario_of();
    const double V0 = cavity::Wall(scenario.mesh, "wall", false).volume();
    scenario.cavities.cavities[0].volume = l * l * l * V0;
    const Solved solved(scenario);
    p.push_back(solved.report().pressure);
    EXPECT_NEAR(p.back(), 4.0 * G * (l - 1.0) / (l * l), 0.09 * p.back()) << l;
    std::printf("[ follower sphere ] l %g: p %.5g Pa, closed form %.5g\n", l, p.back(),
                4.0 * G * (l - 1.0) / (l * l));
  }
  EXPECT_GT(p[1], p[2]);
  const double most = p[1];
  step::Scene below = scenario_of();
  give_pressure(below, 0.9 * most);
  EXPECT_NO_THROW(Solved{below});
  step::Scene above = scenario_of();
  give_pressure(above, 1.1 * most);
  step::Model simulation(above, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> lost = step::initial_state(simulation);
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.why().find("negative curvature"), std::string::npos) << lost.why();
}

// A frozen tube: V/V_0 = (1 + p/2G)² in an infinite body, so that it cannot be drained of more than
// it holds: the step is refused with that reason.
TEST(FrozenTube, LosesItsRoot)
{
  step::Scene scenario = statics(test::tube(16, 2, 6, 0.01, 0.025, 0.008), cavity::Model::frozen);
  scenario.tissue.boundary.fixed = {{"ends", 4}, {"on_x", 2}, {"on_y", 1}};
  cavity::CavitySettings& one = scenario.cavities.cavities[0];
  one.solver = cavity::Solver::exact;
  one.caps = true;
  cavity::ConduitSettings pump;
  pump.name = "pump";
  pump.from = 0;
  pump.flow = 0.3 * cavity::Wall(scenario.mesh, "wall", true).volume();
  scenario.cavities.conduits = {pump};
  scenario.time.step = 1.0;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  step::Outcome<step::Accepted> result = step::initial_state(simulation);
  for (int n = 1; n <= 3; ++n) {
    ASSERT_TRUE(result) << result.why();
    EXPECT_NEAR(result->report.cavities[0].volume / (pump.flow / 0.3), 1.0 - 0.3 * (n - 1), 1e-11);
    result = step::equilibrium(simulation, result->state, {1.0 * n, 1.0, true});
  }
  ASSERT_TRUE(result) << result.why();  // 10 % are left
  result = step::equilibrium(simulation, result->state, {4.0, 1.0, true});
  ASSERT_FALSE(result);
  EXPECT_NE(result.why().find("cavity 'fluid'"), std::string::npos) << result.why();
}

}  // namespace
}  // namespace trocar
