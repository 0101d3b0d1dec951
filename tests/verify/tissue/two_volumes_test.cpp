#include <gtest/gtest.h>

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

// Two halves of unlike compressibility in a row, pressed together: each takes its own part of the
// way, 1/(λ + 2μ), and the dilatation jumps between them. Elements that share their dilatation do
// so within a volume only.
TEST(TwoVolumes, KeepADilatationEach)
{
  for (bool quadratic : {false, true}) {
    step::Scene scenario = confined_bar(quadratic);
    mesh::Mesh& mesh = scenario.mesh;
    mesh.volumes = {"soft", "stiff"};
    for (int t = 0; t < mesh.tet_count(); ++t) {
      double x = 0.0;
      for (const Vec3& corner : mesh::corners(mesh, t)) x += 0.25 * corner.x();
      mesh.region[static_cast<std::size_t>(t)] = x > 0.02 ? 1 : 0;
    }
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
