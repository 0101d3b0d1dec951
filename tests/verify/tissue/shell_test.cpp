#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/cavity.hpp"
#include "support/shell.hpp"

// Elements and laws by the pressure of a cavity in a hollow sphere (docs/verification.md).
namespace trocar {
namespace {

using core::Vec3;
using tissue::Dilatation;

constexpr double a = 0.011, b = 0.025, E = 15000.0;

step::Scene sphere(mesh::Mesh mesh, double poisson, cavity::Model model)
{
  step::Scene scenario = test::fluid_filled(std::move(mesh), {E, poisson, 1000.0, 0.0, 0.0}, model);
  scenario.tissue.boundary.fixed = {{"on_x", 6}, {"on_y", 5}, {"on_z", 3}};
  return scenario;
}

struct Kind
{
  const char* name;
  bool quadratic;
  Dilatation dilatation;
};

/// Relative error of dP/dV of the Lamé shell, against 3u/a of the closed form.
double lame_error(const Kind& kind, int levels, int layers, double poisson)
{
  mesh::Mesh mesh = test::shell(levels, layers, a, b);
  if (kind.quadratic) test::make_round(mesh);
  step::Scene scenario = sphere(std::move(mesh), poisson, cavity::Model::linear);
  scenario.tissue.dilatation = kind.dilatation;
  scenario.cavities.cavities[0].fluid.kind = law::FluidLaw::Kind::pressure;
  scenario.cavities.cavities[0].pressure.mean = 1.0;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> result = step::initial_state(simulation);
  if (!result) throw core::solver_error(result.why());
  const double V0 = simulation.cavities->wall(0).volume();
  const double u =
      a * a * a / (b * b * b - a * a * a) *
      ((1.0 - 2.0 * poisson) * a / E + b * b * b * (1.0 + poisson) / (2.0 * E * a * a));
  return 3.0 * u / a / (result->report.cavities[0].volume / V0 - 1.0) - 1.0;
}

// The stiffness dP/dV on meshes with like numbers of nodes, an eighth of them in each octant.
TEST(LameShellElements, QuadraticTetsFindThePressure)
{
  const std::vector<Kind> kinds{{"p1", false, Dilatation::pointwise},
                                {"p1_anp", false, Dilatation::nodal},
                                {"p2", true, Dilatation::pointwise},
                                {"p2_bbar", true, Dilatation::element},
                                {"p2_anp", true, Dilatation::nodal}};
  for (double poisson : {0.3, 0.485, 0.4999})
    for (const Kind& kind : kinds) {
      const int levels = kind.quadratic ? 2 : 3, layers = kind.quadratic ? 4 : 8;
      mesh::Mesh mesh = test::shell(levels, layers, a, b);
      if (kind.quadratic) test::make_round(mesh);
      const double error = lame_error(kind, levels, layers, poisson);
      std::printf("[ Lamé shell ] %-7s nu %.4f: %d nodes, dP/dV %+.2f %%\n", kind.name, poisson,
                  mesh.node_count(), 100.0 * error);
      const bool locks =
          !kind.quadratic && kind.dilatation == Dilatation::pointwise && poisson > 0.48;
      const bool strained =  // quadratic tets that take θ pointwise lock late, but they do
          kind.quadratic && kind.dilatation == Dilatation::pointwise && poisson > 0.499;
      EXPECT_LT(std::abs(error), strained         ? 0.03
                                 : kind.quadratic ? 0.005
                                 : locks          ? 10.0
                                                  : 0.06)
          << kind.name;
      EXPECT_GT(std::abs(error), locks ? 0.05 : 0.0) << kind.name;
    }
}

/// Pressure in an incompressible neo-Hookean sphere with inner stretch l (Green and Adkins).
double neo_hookean_pressure(double l, double ratio)
{
  const double mu = E / 3.0;
  const double outer = std::cbrt(1.0 + (l * l * l - 1.0) / (ratio * ratio * ratio));
  const auto f = [](double x) { return 2.0 / x + 0.5 / std::pow(x, 4); };
  return mu * (f(outer) - f(l));
}

double pressure_at(const step::Scene& scene, double l)
{
  step::Scene scenario = scene;
  scenario.cavities.cavities[0].volume =
      l * l * l * cavity::Wall(scenario.mesh, "wall", false).volume();
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> result = step::initial_state(simulation);
  if (!result) throw core::solver_error(result.why());
  std::printf("  %d linearisations, %lld factors\n", result->report.linearisations,
              static_cast<long long>(simulation.ledger.factorisations));
  return result->report.cavities[0].pressure;
}

step::Scene neo_hookean_sphere(int levels, int layers, double outer)
{
  mesh::Mesh mesh = test::shell(levels, layers, a, outer);
  test::make_round(mesh);
  step::Scene scenario = sphere(std::move(mesh), 0.49999, cavity::Model::follower);
  scenario.tissue.model = tissue::Model::neo_hookean;
  scenario.tissue.dilatation = Dilatation::nodal;
  return scenario;
}

TEST(NeoHookeanSphere, PressureOfThirtyPercentOfVolume)
{
  const step::Scene scenario = neo_hookean_sphere(2, 4, b);
  for (double ratio : {0.7, 1.3}) {
    const double l = std::cbrt(ratio);
    const double p = pressure_at(scenario, l), exact = neo_hookean_pressure(l, b / a);
    std::printf("[ neo-Hookean sphere ] V/V0 %.1f: p %.4g Pa, closed form %.4g (%+.2f %%)\n", ratio,
                p, exact, 100.0 * (p / exact - 1.0));
    EXPECT_NEAR(p, exact, 0.005 * std::abs(exact));
  }
}

// A thin shell: p ~ 1/l - 1/l⁷ is greatest at l = 7^(1/6) = 1.383. Volume control goes past it.
TEST(NeoHookeanSphere, ThinShellPassesItsLimitPoint)
{
  const double ratio = 1.1, limit = std::pow(7.0, 1.0 / 6.0);
  const step::Scene scenario = neo_hookean_sphere(2, 1, ratio * a);
  std::vector<double> p;
  for (double l : {0.9 * limit, limit, 1.15 * limit}) {
    p.push_back(pressure_at(scenario, l));
    const double exact = neo_hookean_pressure(l, ratio);
    std::printf("[ thin shell ] l %.3f: p %.4g Pa, closed form %.4g (%+.2f %%)\n", l, p.back(),
                exact, 100.0 * (p.back() / exact - 1.0));
    EXPECT_NEAR(p.back(), exact, 0.01 * exact);
  }
  EXPECT_GT(p[1], p[0]);
  EXPECT_GT(p[1], p[2]);
}

}  // namespace
}  // namespace trocar
