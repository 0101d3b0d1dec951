#include <gtest/gtest.h>

#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using test::distorted;
using test::plain;

// A rejected step leaves no trace: trying an impossible step in between changes nothing.
TEST(State, ARejectedStepLeavesNoTrace)
{
  step::Scene scenario = test::needle_scenario(distorted);
  scenario.tissue.model = tissue::Model::corotational;
  const base::Comm comm(MPI_COMM_WORLD);
  step::Model plain_run(scenario, comm), tried(scenario, comm);
  step::State a = step::initial_state(plain_run)->state, b = step::initial_state(tried)->state;
  for (int n = 1; n <= 20; ++n) {
    const core::TimeStep now{0.02 * n, 0.02, false};
    step::advance(tried, b,
                  {0.02 * n + 5.0, 5.0, false});  // far too long; accepted or not, it is dropped
    a = step::advance(plain_run, a, now)->state;
    b = step::advance(tried, b, now)->state;
  }
  EXPECT_LT((a.tissue.u.value - b.tissue.u.value).norm(), 1e-14);
  EXPECT_EQ(a.insertions[0].points.size(), b.insertions[0].points.size());
}

// Iterating the linearisation changes a bent corotational step a little and then nothing.
TEST(Newton, IteratedStepsBalanceTheTrueForces)
{
  step::Scene scenario = test::needle_scenario(plain);
  scenario.needles[0].model = needle::Model::beam;
  scenario.tissue.model = tissue::Model::corotational;
  scenario.time.newton_max = 30;
  scenario.time.end = 0.8;
  const test::Run run = test::run(scenario);
  for (std::size_t n = 1; n < run.reports.size(); ++n) {
    EXPECT_LT(run.reports[n].linearisations, 30);
    EXPECT_LE(run.reports[n].residual, 1e-9);
  }
}

/// Force on the base of a beam whose base moved 1 cm sideways within 1 s.
Vec3 side_force(double h, int directions, int newton, core::Ledger& ledger)
{
  step::Scene scenario = test::needle_scenario(distorted);
  scenario.needles[0].model = needle::Model::beam;
  scenario.needles[0].section = {0.0004, 0.0, 7e10, 0.3};
  scenario.needles[0].motion.inserted = 0.03;
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.05,0.0173,0.0231\n1,-0.05,0.0273,0.0231\n", "aside.csv");
  scenario.insertion.friction = test::same({0.0, 0.0, 100.0});
  scenario.time.step = h;
  scenario.time.end = 1.0;
  scenario.time.direction_max = directions;
  scenario.time.newton_max = newton;
  const test::Run run = test::run(scenario);
  ledger = run.ledger;
  return run.reports.back().needles[0].base.force;
}

// Frozen directions miss what a bending needle does within the step; one update of them gives the
// accuracy of the fully iterated step for a fraction of its solves.
TEST(Directions, OneUpdateIsWorthTheIteratedStep)
{
  core::Ledger frozen_work, updated_work, iterated_work;
  const Vec3 exact = side_force(0.0125, 1, 30, iterated_work);
  const Vec3 frozen = side_force(0.1, 1, 1, frozen_work);
  const Vec3 updated = side_force(0.1, 2, 1, updated_work);
  const Vec3 iterated = side_force(0.1, 1, 30, iterated_work);
  EXPECT_GT((frozen - exact).norm(), 10.0 * (updated - exact).norm());
  EXPECT_LT((updated - exact).norm(), 2.0 * (iterated - exact).norm() + 0.01 * exact.norm());
  EXPECT_LE(updated_work.half_sweeps, frozen_work.half_sweeps * 3 / 2);
  EXPECT_GT(iterated_work.half_sweeps, 2 * updated_work.half_sweeps);
}

}  // namespace
}  // namespace trocar
