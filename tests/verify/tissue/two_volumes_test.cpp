#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// A bar along x without a needle that slides between walls at y and z, held at x0: every section
/// moves as a whole.
step::Scene confined_bar(bool quadratic)
{
  test::BlockShape shape{4, 2, 2, Vec3(0.04, 0.02, 0.02), 0.0};
  shape.quadratic = quadratic;
  step::Scene scenario = test::needle_scenario(shape);
  scenario.needles.clear();
  scenario.time.is_static = true;
  scenario.tissue.boundary.fixed = {{"x0", 1}, {"y0", 2}, {"y1", 2}, {"z0", 4}, {"z1", 4}};
  return scenario;
}

/// Displacements along x of all nodes at this x.
std::vector<double> at(const step::Scene& scenario, const fem::GlobalField& u, double x)
{
  std::vector<double> found;
  for (int node = 0; node < scenario.mesh.node_count(); ++node)
    if (std::abs(scenario.mesh.x[static_cast<std::size_t>(node)].x() - x) < 1e-9)
      found.push_back(u.node(node).x());
  return found;
}

/// Two volumes, one behind the other.
void halve(mesh::Mesh& mesh)
{
  mesh.volumes = {"first", "second"};
  for (int t = 0; t < mesh.tet_count(); ++t) {
    double x = 0.0;
    for (const Vec3& corner : mesh::corners(mesh, t)) x += 0.25 * corner.x();
    mesh.region[static_cast<std::size_t>(t)] = x > 0.02 ? 1 : 0;
  }
}

// Two halves of unlike compressibility in a row, pressed together: each takes its own part of the
// way, 1/(λ + 2μ), and the dilatation jumps between them. Elements that share their dilatation do
// so within a volume only.
TEST(TwoVolumes, KeepADilatationEach)
{
  for (bool quadratic : {false, true}) {
    step::Scene scenario = confined_bar(quadratic);
    halve(scenario.mesh);
    const tissue::Material soft{5000.0, 0.3, 1000.0, 0.0, 0.0};
    const tissue::Material stiff{5000.0, 0.49, 1000.0, 0.0, 0.0};
    scenario.tissue.materials = {soft, stiff};
    scenario.tissue.dilatation = tissue::Dilatation::nodal;
    scenario.tissue.boundary.displacements = {{"x1", Vec3(-1e-4, 0.0, 0.0), std::nullopt}};
    step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
    const step::Outcome<step::Accepted> start = step::initial_state(simulation);
    ASSERT_TRUE(start) << start.why();
    const fem::GlobalField u = simulation.space.gather(start->state.tissue.u);
    const double of_soft = 1.0 / (soft.lambda() + 2.0 * soft.mu());
    const double of_stiff = 1.0 / (stiff.lambda() + 2.0 * stiff.mu());
    for (double between : at(scenario, u, 0.02))
      EXPECT_NEAR(between, -1e-4 * of_soft / (of_soft + of_stiff), 1e-12);
    const double force = 1e-4 / 0.02 / (of_soft + of_stiff) * 0.02 * 0.02;
    EXPECT_NEAR(start->report.holders.tools[0].x(), -force, 1e-9 * force);
  }
}

constexpr tissue::Model models[] = {tissue::Model::linear, tissue::Model::corotational,
                                    tissue::Model::neo_hookean};

/// First Piola stress of a confined bar that is stretched by 1 + e [Pa], by hand.
double stress(tissue::Model model, const tissue::Material& m, double e)
{
  const double F = 1.0 + e;
  if (model != tissue::Model::neo_hookean) return (m.lambda() + 2.0 * m.mu()) * e;
  return m.mu() * (F - 1.0 / F) + m.lambda() * (F - 1.0);
}

/// What of the shortening `both` of two halves the first takes, where both bear the same:
/// bisection.
double share(const std::array<tissue::Model, 2>& model, const std::vector<tissue::Material>& m,
             double both)
{
  double low = -0.9, high = 0.9;
  for (int k = 0; k < 200; ++k) {
    const double e = 0.5 * (low + high);
    (stress(model[0], m[0], e) > stress(model[1], m[1], both - e) ? high : low) = e;
  }
  return 0.5 * (low + high);
}

// Every pair of laws, a fifth shorter: the halves bear the same and share the way by their laws.
TEST(TwoModels, BearTheSameStress)
{
  for (bool quadratic : {false, true})
    for (tissue::Model first : models)
      for (tissue::Model second : models) {
        step::Scene scenario = confined_bar(quadratic);
        halve(scenario.mesh);
        std::vector<tissue::Material> m{{5000.0, 0.3, 1000.0, 0.0, 0.0},
                                        {8000.0, 0.2, 1000.0, 0.0, 0.0}};
        m[0].model = first;
        m[1].model = second;
        scenario.tissue.materials = m;
        scenario.tissue.newton_tolerance = 1e-12;
        scenario.tissue.boundary.displacements = {{"x1", Vec3(-8e-3, 0.0, 0.0), std::nullopt}};
        step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
        const step::Outcome<step::Accepted> start = step::initial_state(simulation);
        ASSERT_TRUE(start) << start.why();
        const fem::GlobalField u = simulation.space.gather(start->state.tissue.u);
        const double e = share({first, second}, m, -0.4);
        for (double between : at(scenario, u, 0.02)) EXPECT_NEAR(between, 0.02 * e, 1e-10);
        const double force = stress(first, m[0], e) * 0.02 * 0.02;
        EXPECT_NEAR(start->report.holders.tools[0].x(), force, 1e-8 * std::abs(force));
      }
}

/// A bar whose first half is stiff and whose second half hangs down from it by its weight, far
/// beyond small strains.
step::Scene hanging(tissue::Model stiff)
{
  test::BlockShape shape{8, 2, 2, Vec3(0.04, 0.01, 0.01), 0.0};
  step::Scene scenario = test::needle_scenario(shape);
  halve(scenario.mesh);
  scenario.needles.clear();
  scenario.time.is_static = true;
  tissue::TissueSettings& tissue = scenario.tissue;
  tissue.boundary.fixed = {{"x0", 7}};
  tissue.boundary.gravity = Vec3(0.0, 0.0, -9.81);
  tissue.materials = {{1e8, 0.3, 1000.0, 0.0, 0.0}, {3000.0, 0.3, 1000.0, 0.0, 0.0}};
  tissue.materials[0].model = stiff;
  tissue.materials[1].model = tissue::Model::corotational;
  tissue.newton_tolerance = 1e-10;
  return scenario;
}

fem::GlobalField shape_of(const step::Scene& scenario)
{
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> start = step::initial_state(simulation);
  EXPECT_TRUE(start) << start.why();
  return simulation.space.gather(start->state.tissue.u);
}

// Where the linear half hardly moves it may as well be corotational; what turns beside it turns as
// ever, with the exact tangent, with held rotations, and with a factor that lags.
TEST(TwoModels, TurnBesideLinearTissue)
{
  const fem::GlobalField u = shape_of(hanging(tissue::Model::corotational));
  const double lowest = u.value.minCoeff();
  EXPECT_LT(lowest, -0.005);  // a quarter of its length
  for (auto tangent : {tissue::Tangent::exact, tissue::Tangent::rotated})
    for (double lag : {0.0, 1e-8}) {
      step::Scene scenario = hanging(tissue::Model::linear);
      scenario.tissue.tangent = tangent;
      scenario.tissue.lag_tolerance = lag;
      const fem::GlobalField beside = shape_of(scenario);
      EXPECT_LT((beside.value - u.value).cwiseAbs().maxCoeff(), 1e-4 * std::abs(lowest));
    }
}

// What linear tissue may do with -tissue_allow_inversion other tissue beside it may not.
TEST(TwoModels, OnlyLinearTissueMayBeTurnedInsideOut)
{
  for (auto first : {tissue::Model::linear, tissue::Model::corotational})
    for (bool allowed : {true, false}) {
      step::Scene scenario = confined_bar(false);
      halve(scenario.mesh);
      scenario.tissue.materials = {{1000.0, 0.3, 1000.0, 0.0, 0.0}, {1e6, 0.3, 1000.0, 0.0, 0.0}};
      scenario.tissue.model = tissue::Model::corotational;
      scenario.tissue.materials[0].model = first;
      scenario.tissue.materials[1].model =
          first == tissue::Model::linear ? tissue::Model::corotational : tissue::Model::linear;
      scenario.tissue.allow_inversion = allowed;
      // More than the soft half is long.
      scenario.tissue.boundary.displacements = {{"x1", Vec3(-0.025, 0.0, 0.0), std::nullopt}};
      step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
      const step::Outcome<step::Accepted> start = step::initial_state(simulation);
      EXPECT_EQ(static_cast<bool>(start), allowed && first == tissue::Model::linear);
      if (start) {
        ASSERT_GE(start->report.folded, 0);
        EXPECT_EQ(scenario.mesh.region[static_cast<std::size_t>(start->report.folded)], 0);
      } else {
        EXPECT_NE(start.why().find("inside out"), std::string::npos) << start.why();
        EXPECT_NE(start.why().find("'first'"), std::string::npos) << start.why();
      }
    }
}

// A traction that grows in time: at the end of every static step the bar is where the load of that
// moment has it.
TEST(Traction, IsThatOfTheEndOfTheStep)
{
  step::Scene scenario = confined_bar(false);
  scenario.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.tractions = {
      {"x1", Vec3(20.0, 0.0, 0.0), core::parse_csv("time,factor\n0,0\n1,1\n", "ramp.csv")}};
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  step::Outcome<step::Accepted> result = step::initial_state(simulation);
  const tissue::Material& m = scenario.tissue.materials[0];
  const double whole = 20.0 / (m.lambda() + 2.0 * m.mu()) * 0.04;
  for (int n = 1; n <= 4; ++n) {
    result = step::equilibrium(simulation, result->state, {0.25 * n, 0.25, true});
    ASSERT_TRUE(result) << result.why();
    const fem::GlobalField u = simulation.space.gather(result->state.tissue.u);
    for (double end : at(scenario, u, 0.04)) EXPECT_NEAR(end, 0.25 * n * whole, 1e-10 * whole);
  }
}

}  // namespace
}  // namespace trocar
