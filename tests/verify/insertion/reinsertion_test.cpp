#include <gtest/gtest.h>

#include <algorithm>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using test::distorted;
using test::plain;

TEST(Withdrawal, LeavesNoPointAndReturnsTheTissue)
{
  for (needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    step::Scene scenario = test::needle_scenario(distorted);
    scenario.needles[0].model = model;
    scenario.tissue.model = tissue::Model::corotational;
    scenario.needles[0].motion.hold = 0.1;
    scenario.needles[0].motion.withdraw_velocity = 0.04;
    scenario.time.end = 5.0;
    const test::Run run = test::run(scenario);
    const auto& last = run.states.back();
    EXPECT_EQ(last.insertions[0].phase, insertion::Phase::withdrawn);
    EXPECT_TRUE(last.insertions[0].points.empty());
    EXPECT_EQ(run.reports.back().rows, 0);
    double largest = 0.0;
    for (const auto& state : run.states)
      largest = std::max(
          largest, state.tissue.u.value.size() ? state.tissue.u.value.cwiseAbs().maxCoeff() : 0.0);
    const base::Comm comm(MPI_COMM_WORLD);
    const double left =
        last.tissue.u.value.size() ? last.tissue.u.value.cwiseAbs().maxCoeff() : 0.0;
    EXPECT_LT(comm.max(left), 1e-6 * comm.max(largest));
  }
}

TEST(Reinsertion, GoesBackInThroughTheOpenChannel)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.needles[0].motion.trajectory = core::parse_csv(
      "time,x,y,z\n0,-0.08,0.0173,0.0231\n1,-0.05,0.0173,0.0231\n2,-0.09,0.0173,0.0231\n"
      "3,-0.05,0.0173,0.0231\n",
      "in_out_in.csv");
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  const auto& first = run.states[50].insertions[0];
  const auto& out = run.states[100].insertions[0];
  const auto& again = run.states[150].insertions[0];
  EXPECT_TRUE(out.points.empty());
  EXPECT_EQ(out.path.sites.size(), first.path.sites.size());
  ASSERT_GE(again.points.size(), first.points.size() - 1);
  // The same places, hence the same identities; the channel was not cut anew beside itself.
  for (std::size_t k = 0; k < std::min(first.points.size(), again.points.size()); ++k)
    EXPECT_EQ(again.points[k].site, first.points[k].site);
  EXPECT_LE(again.path.sites.size(), first.path.sites.size() + 1);
}

TEST(Reinsertion, TenCyclesDoNotDrift)
{
  step::Scene scenario = test::needle_scenario(distorted);
  std::string rows = "time,x,y,z\n0,-0.08,0.0173,0.0231\n";
  for (int cycle = 0; cycle < 10; ++cycle) {
    rows += std::to_string(2 * cycle + 1) + ",-0.05,0.0173,0.0231\n";
    rows += std::to_string(2 * cycle + 2) + ",-0.085,0.0173,0.0231\n";
  }
  scenario.needles[0].motion.trajectory = core::parse_csv(rows, "cycles.csv");
  scenario.insertion.friction = test::same({3.0, 2.0, 0.0});
  scenario.time.end = 20.0;
  const test::Run run = test::run(scenario);
  const auto& second = run.reports[150].needles[0];
  const auto& last = run.reports[950].needles[0];
  EXPECT_GT(second.base.force.norm(), 0.05);
  EXPECT_LT((last.base.force - second.base.force).norm(), 1e-6 * second.base.force.norm());
  EXPECT_NEAR(last.depth, second.depth, 1e-9);
  EXPECT_EQ(run.states[950].insertions[0].path.sites.size(),
            run.states[150].insertions[0].path.sites.size());
  EXPECT_TRUE(run.states.back().insertions[0].points.empty());
}

// Somewhere else it cuts a channel of its own, with identities of its own.
TEST(Reinsertion, CutsANewChannelBesideTheOldOne)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.needles[0].motion.trajectory = core::parse_csv(
      "time,x,y,z\n0,-0.08,0.0131,0.0231\n1,-0.05,0.0131,0.0231\n2,-0.09,0.0131,0.0231\n"
      "2.5,-0.09,0.0271,0.0231\n4,-0.05,0.0271,0.0231\n",
      "aside.csv");
  scenario.time.end = 4.0;
  const test::Run run = test::run(scenario);
  const auto& first = run.states[50].insertions[0];
  const auto& last = run.states[200].insertions[0];
  EXPECT_NEAR(last.path.vertex.front().y(), 0.0271, 1e-3);
  EXPECT_GT(run.reports[200].needles[0].depth, 0.02);
  EXPECT_GE(last.path.first_id, first.path.first_id + static_cast<int>(first.path.sites.size()));
  // Nothing is dragged over from the old channel 14 mm beside: as if it had never been there.
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.09,0.0271,0.0231\n1.5,-0.05,0.0271,0.0231\n", "new.csv");
  scenario.time.end = 1.5;
  const Vec3 fresh = test::run(scenario).reports.back().needles[0].base.force;
  EXPECT_LT((run.reports[200].needles[0].base.force - fresh).norm(), 1e-3 * fresh.norm());
}

}  // namespace
}  // namespace trocar
