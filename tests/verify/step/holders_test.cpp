#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;

const Vec3 size(0.06, 0.04, 0.03), gravity(1.0, -2.0, -9.81), pull(300.0, 40.0, -70.0);

/// A block that stands on z0, leans against x0 and is pulled at x1 beside its weight.
step::Scene loaded(bool is_static)
{
  step::Scene scenario = test::needle_scenario({5, 3, 3, size, 0.2});
  scenario.needles.clear();
  scenario.time.is_static = is_static;
  scenario.time.end = 0.0;
  scenario.tissue.boundary.fixed = {{"z0", 7}, {"x0", 1}};
  scenario.tissue.boundary.gravity = gravity;
  scenario.tissue.boundary.tractions = {{"x1", pull, std::nullopt}};
  return scenario;
}

Vec3 loads(const step::Scene& scenario)
{
  return scenario.tissue.materials[0].density * size.prod() * gravity + size.y() * size.z() * pull;
}

Vec3 sum(const tissue::Reactions& holders)
{
  Vec3 total = Vec3::Zero();
  for (const auto* forces : {&holders.tools, &holders.supports})
    for (const Vec3& force : *forces) total += force;
  return total;
}

tissue::Reactions at_rest(const step::Scene& scenario, MPI_Comm comm = MPI_COMM_WORLD)
{
  step::Model simulation(scenario, base::Comm(comm));
  const step::Outcome<step::Accepted> result = step::initial_state(simulation);
  EXPECT_TRUE(result) << result.why();
  return result->report.holders;
}

TEST(Supports, CarryTheLoads)
{
  step::Scene scenario = loaded(true);
  using tissue::Model;
  for (const Model model : {Model::linear, Model::corotational, Model::neo_hookean})
    for (const auto dilatation : {tissue::Dilatation::pointwise, tissue::Dilatation::nodal}) {
      scenario.tissue.model = model;
      scenario.tissue.dilatation = dilatation;
      const tissue::Reactions holders = at_rest(scenario);
      ASSERT_EQ(holders.supports.size(), 2U);
      const double tolerance = model == Model::linear ? 1e-10 : 1e-7;  // iterated to 1e-8
      EXPECT_LT((sum(holders) + loads(scenario)).norm(), tolerance * loads(scenario).norm());
      EXPECT_LT(holders.supports[1].x(), -0.1 * pull.x() * size.y() * size.z());  // they share it
      EXPECT_EQ(holders.supports[1].tail<2>().norm(), 0.0);  // x0 is free to slide
    }
}

// A dof counts once: with a tool that holds it, else with the first of its supports.
TEST(Supports, CountEveryDofOnce)
{
  step::Scene scenario = loaded(true);
  const tissue::Reactions first = at_rest(scenario);
  scenario.tissue.boundary.fixed = {{"x0", 1}, {"z0", 7}, {"z0", 4}};
  const tissue::Reactions second = at_rest(scenario);
  EXPECT_GT((first.supports[1] - second.supports[0]).norm(), 1e-3 * loads(scenario).norm());
  EXPECT_LT((sum(first) - sum(second)).norm(), 1e-10 * loads(scenario).norm());
  EXPECT_EQ(second.supports[2], Vec3(Vec3::Zero()));
  const double free = std::numeric_limits<double>::quiet_NaN();
  scenario.tissue.boundary.displacements = {{"z0", Vec3(free, free, 0.0), std::nullopt, {}}};
  const tissue::Reactions held = at_rest(scenario);
  EXPECT_NEAR(held.tools[0].z(), second.supports[1].z(), 1e-10 * loads(scenario).norm());
  EXPECT_EQ(held.supports[1].z(), 0.0);
  EXPECT_LT((sum(held) + loads(scenario)).norm(), 1e-10 * loads(scenario).norm());
}

TEST(Supports, CarryTheSameOnAnyNumberOfRanks)
{
  step::Scene scenario = loaded(true);
  scenario.tissue.dilatation = tissue::Dilatation::nodal;
  const tissue::Reactions ours = at_rest(scenario), alone = at_rest(scenario, MPI_COMM_SELF);
  for (std::size_t k : {0, 1})
    EXPECT_LT((ours.supports[k] - alone.supports[k]).norm(), 1e-10 * loads(scenario).norm());
}

// A body let go: its supports carry loads less what sets it in motion, Σ m a with a quarter of
// every tet's mass at its corners.
TEST(Supports, CarryLoadsLessInertia)
{
  step::Scene scenario = loaded(false);
  scenario.time.step = 1e-3;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const fem::Space& space = simulation.space;
  step::Outcome<step::Accepted> result = step::initial_state(simulation);
  EXPECT_EQ(sum(result->report.holders), Vec3(Vec3::Zero()));
  for (int n = 1; n <= 5; ++n) {
    const fem::OwnedField before = result->state.tissue.v;
    result = step::advance(simulation, result->state,
                           {n * scenario.time.step, scenario.time.step, false});
    ASSERT_TRUE(result) << result.why();
    const fem::GlobalField a =
        space.gather({(result->state.tissue.v.value - before.value) / scenario.time.step});
    Vec3 inertia = Vec3::Zero();
    for (int t = 0; t < scenario.mesh.tet_count(); ++t)
      for (int node : scenario.mesh.tets[static_cast<std::size_t>(t)])
        inertia += 0.25 * scenario.tissue.materials[0].density *
                   mesh::tet_volume(scenario.mesh, t) * a.node(node);
    EXPECT_GT(inertia.norm(), 1e-2 * loads(scenario).norm());
    EXPECT_LT((sum(result->report.holders) + loads(scenario) - inertia).norm(),
              1e-9 * loads(scenario).norm());
  }
}

}  // namespace
}  // namespace trocar
