#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using test::distorted;
using test::plain;

using insertion::Placement;
const std::vector<std::pair<needle::Model, Placement>> ways{
    {needle::Model::rigid, Placement::crossings},
    {needle::Model::beam, Placement::crossings},
    {needle::Model::rigid, Placement::line},
    {needle::Model::beam, Placement::line}};

// What the holder puts in is what the tissue feels. The tissue's side is taken from its own
// unbalanced nodal forces, which only the rows can balance.
TEST(Balance, ActionEqualsReaction)
{
  for (const auto& [model, placement] : ways) {
    step::Scene scenario = test::needle_scenario(distorted);
    scenario.needles[0].model = model;
    scenario.insertion.placement.placement = placement;
    const base::Comm comm(MPI_COMM_WORLD);
    step::Model simulation(scenario, comm);
    step::State state = step::initial_state(simulation)->state;
    double worst = 0.0, largest = 0.0;
    for (int n = 1; n <= 60; ++n) {
      const core::TimeStep now{0.02 * n, 0.02, false};
      const step::Outcome<step::Accepted> result = step::advance(simulation, state, now);
      ASSERT_TRUE(result) << result.why();
      const fem::GlobalField unbalanced = simulation.space.gather(
          simulation.tissue.residual(state.tissue, result->state.tissue.u, now));
      Vec3 on_tissue = Vec3::Zero();
      for (int node = 0; node < scenario.mesh.node_count(); ++node)
        on_tissue -= unbalanced.node(node);
      worst = std::max(worst, (result->report.needles[0].base.force - on_tissue).norm());
      largest = std::max(largest, on_tissue.norm());
      state = result->state;
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(worst, 1e-10 * largest);
  }
}

// The same in an iterated static state of a corotational body under its weight.
TEST(Balance, ActionEqualsReactionInEquilibrium)
{
  for (const auto& [model, placement] : ways) {
    step::Scene scenario = test::needle_scenario(distorted);
    scenario.needles[0].model = model;
    scenario.insertion.placement.placement = placement;
    scenario.time.is_static = true;
    scenario.tissue.model = tissue::Model::corotational;
    scenario.tissue.boundary.gravity = Vec3(0, 0, -9.81);
    scenario.needles[0].motion.inserted = 0.03;
    const base::Comm comm(MPI_COMM_WORLD);
    step::Model simulation(scenario, comm);
    const step::Outcome<step::Accepted> start = step::initial_state(simulation);
    ASSERT_TRUE(start) << start.why();
    const fem::GlobalField unbalanced = simulation.space.gather(simulation.tissue.residual(
        tissue::at_rest(simulation.space), start->state.tissue.u, {0, 1, true}));
    Vec3 on_tissue = Vec3::Zero();
    for (int node = 0; node < scenario.mesh.node_count(); ++node)
      on_tissue -= unbalanced.node(node);
    const Vec3 needle = start->report.needles[0].base.force;
    EXPECT_GT(needle.norm(), 1e-3);
    EXPECT_LT((on_tissue - needle).norm(), 1e-6 * needle.norm());
  }
}

// A plate holds the body and a needle sticks in it beside that plate, where some of the nodes it
// takes hold of are the plate's: what the holder pushes with is all that the plate feels.
TEST(Balance, APlateFeelsWhatTheNeedleDoesOnItsNodes)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.time.is_static = true;
  scenario.tissue.boundary.fixed.clear();
  scenario.tissue.boundary.displacements = {{"z0", Vec3::Zero(), std::nullopt}};
  scenario.needles[0].motion.entry = Vec3(0, 0.0173, 0.0031);
  scenario.needles[0].motion.inserted = 0.03;
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.05,0.0173,0.0031\n1,-0.05,0.0173,0.0061\n", "aside.csv");
  scenario.time.end = 0.04;
  const test::Run run = test::run(scenario);
  const Vec3 holder = run.reports.back().needles[0].base.force;
  EXPECT_GT(holder.norm(), 1e-3);
  EXPECT_LT((run.reports.back().holders.tools[0] + holder).norm(), 1e-9 * holder.norm());
}

// A needle row whose nodes are all prescribed has no force; its gap stays and statics converge.
// Drawn aside where a support holds the tissue: no force closes that gap, and the step says where.
TEST(Balance, AGapThatASupportHoldsOpenIsRefused)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.time.is_static = true;
  scenario.tissue.boundary.fixed = {{"z0", 7}, {"x0", 7}};
  scenario.needles[0].motion.entry = Vec3(0, 0.02, 0.02);
  scenario.needles[0].motion.inserted = 0.03;
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.05,0.02,0.02\n1,-0.05,0.021,0.02\n", "aside.csv");
  scenario.time.end = 0.04;
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  const step::Outcome<step::Accepted> start = step::initial_state(simulation);
  ASSERT_TRUE(start) << start.why();
  const step::Outcome<step::Accepted> aside =
      step::advance(simulation, start->state, {0.01, 0.01, true});
  ASSERT_FALSE(aside);
  EXPECT_NE(aside.why().find("needle 'needle' where the undeformed tissue has (0, 0.02, 0.02) m"),
            std::string::npos)
      << aside.why();
}

// A needle through a held face slips there as anywhere else, rigid or not: its base carries the
// friction of all its length.
TEST(Balance, AHeldFaceRubsLikeAnyOther)
{
  for (needle::Model model : {needle::Model::rigid, needle::Model::beam})
    for (bool withdraws : {false, true}) {
      step::Scene scenario = test::needle_scenario(plain);
      scenario.time.is_static = true;
      scenario.tissue.boundary.fixed = {{"x0", 7}};
      scenario.tissue.materials[0].young = 1e7;
      scenario.insertion.friction = test::same({20.0, 20.0, 0.0});
      needle::NeedleSettings& needle = scenario.needles[0];
      needle.model = model;
      needle.motion.entry = Vec3(0, 0.0193, 0.0171);
      needle.motion.velocity = 0.02;
      needle.motion.depth = 0.03;
      needle.motion.withdraw_velocity = withdraws ? 0.02 : 0.0;
      scenario.time.step = 0.1;
      scenario.time.end = withdraws ? 2.0 : 1.3;
      const test::Run run = test::run(scenario);
      const step::NeedleReport& last = run.reports.back().needles[0];
      const double friction = (withdraws ? -20.0 : 20.0) * last.depth;
      EXPECT_GT(last.depth, 0.015);
      EXPECT_NEAR(last.base.force.x(), friction, 1e-3 * std::abs(friction));
    }
}

}  // namespace
}  // namespace trocar
