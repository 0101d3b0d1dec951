#include <gtest/gtest.h>

#include <algorithm>

#include "step/archive.hpp"
#include "support/scene.hpp"

namespace trocar::step {
namespace {

using core::Vec3;

/// A bending needle that punctures and cuts turning tissue, damped, by BDF2, with all accounts.
Scene busy()
{
  Scene scene = test::needle_scenario(test::distorted);
  scene.tissue.model = tissue::Model::corotational;
  scene.needles[0].model = needle::Model::beam;
  scene.needles[0].density = 7850.0;
  scene.time.second_order = true;
  scene.energy = true;
  scene.insertion.friction = test::same({12.0, 8.0, 1.0});
  scene.insertion.puncture.volume = {0.1};
  scene.insertion.tip.cutting = {0.05};
  scene.tissue.reuse = solve::Reuse::none;
  return scene;
}

/// The same with a factor that lags, which steps of the same length go on with.
Scene lagging()
{
  Scene scene = busy();
  scene.tissue.reuse = solve::Reuse::exact;
  scene.tissue.lag_tolerance = 1e-13;
  scene.time.newton_max = 1;
  return scene;
}

/// Takes one step with each of two models; they come to the same but for how columns are rounded.
void both_step(Model& one, State& a, Model& other, State& b, int n)
{
  const core::TimeStep now{0.02 * n, 0.02, false};
  const auto first = advance(one, a, now), second = advance(other, b, now);
  ASSERT_TRUE(first && second) << first.why() << second.why();
  a = first->state;
  b = second->state;
  EXPECT_EQ(a.tissue.age.uses, b.tissue.age.uses) << n;
  EXPECT_EQ(first->report.passes, second->report.passes) << n;
  EXPECT_LE((a.tissue.u.value - b.tissue.u.value).norm(), 1e-10 * a.tissue.u.value.norm());
}

// No list is told without its size: what is put together again from the numbers says the same of
// itself.
TEST(State, SaysAllOfItself)
{
  Scene scene = busy();
  scene.time.end = 0.6;
  Model model(scene, base::Comm(MPI_COMM_WORLD));
  State state = initial_state(model)->state;
  for (int n = 1; n <= 30; ++n) state = advance(model, state, {0.02 * n, 0.02, false})->state;
  const core::Archive all = archived(state, model.space);
  EXPECT_EQ(archived(restored(all, model.space), model.space), all);
  if (!model.space.comm().root()) return;
  for (const char* name : {"time [s]", "tissue/displacement [m]", "needle/0/shaft/frame/3 [1]",
                           "insertion/0/point/1/lambda [N]", "insertion/0/tip/hold/weight [1]",
                           "before/tissue/velocity [m/s]", "energy/supplied [J]"})
    EXPECT_EQ(std::count(all.names.begin(), all.names.end(), name), 1) << name;
}

// A run that goes on from such numbers alone, with bodies that know nothing of the steps before, is
// the same to the last bit: all that a step depends on is in the state.
TEST(State, IsAllThatAStepDependsOn)
{
  const Scene scene = busy();
  Model through(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(through)->state;
  const auto step = [&](Model& model, const State& from, int n) {
    auto next = advance(model, from, {0.02 * n, 0.02, false});
    EXPECT_TRUE(next) << next.why();
    return std::move(next->state);
  };
  for (int n = 1; n <= 20; ++n) a = step(through, a, n);
  State b = restored(archived(a, through.space), through.space);
  Model fresh(scene, base::Comm(MPI_COMM_WORLD));
  for (int n = 21; n <= 30; ++n) {
    a = step(through, a, n);
    b = step(fresh, b, n);
    ASSERT_EQ(archived(a, through.space), archived(b, fresh.space)) << "step " << n;
  }
  EXPECT_GT(a.insertions[0].points.size(), 2U);
}

// With a factor that lags as well: it is made again from what the state says of it, and goes on
// wearing out from where it was. Columns that are computed in other portions are rounded otherwise.
TEST(State, SaysWhatALaggingFactorWasMadeFrom)
{
  const Scene scene = lagging();
  Model through(scene, base::Comm(MPI_COMM_WORLD)), fresh(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(through)->state;
  for (int n = 1; n <= 20; ++n) a = advance(through, a, {0.02 * n, 0.02, false})->state;
  ASSERT_TRUE(a.tissue.factor);
  EXPECT_GT(a.tissue.age.uses, 1);
  State b = restored(archived(a, through.space), through.space);
  int older = 0;
  for (int n = 21; n <= 40; ++n) {
    both_step(through, a, fresh, b, n);
    older += a.tissue.age.lags ? 1 : 0;
  }
  EXPECT_GT(older, 5);
}

// A checkpoint is a barrier: a run that drops its caches there, and another one that knows nothing
// but what the state says, go on alike to the last bit.
TEST(State, AndNoCachesAreABarrier)
{
  const Scene scene = lagging();
  Model through(scene, base::Comm(MPI_COMM_WORLD)), fresh(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(through)->state;
  for (int n = 1; n <= 20; ++n) a = advance(through, a, {0.02 * n, 0.02, false})->state;
  EXPECT_GT(a.tissue.age.uses, 1);
  State b = restored(archived(a, through.space), fresh.space);
  through.drop_caches();
  for (int n = 21; n <= 40; ++n) {
    const core::TimeStep now{0.02 * n, 0.02, false};
    a = advance(through, a, now)->state;
    b = advance(fresh, b, now)->state;
    ASSERT_EQ(archived(a, through.space), archived(b, fresh.space)) << "step " << n;
  }
}

// A step that was tried in between, and caches that are dropped, change nothing but what columns
// are rounded to.
TEST(State, IsNotChangedByWhatWasTriedOrDropped)
{
  const Scene scene = lagging();
  Model plain(scene, base::Comm(MPI_COMM_WORLD)), tried(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(plain)->state, b = initial_state(tried)->state;
  for (int n = 1; n <= 20; ++n) {
    if (n % 3 == 0) (void)advance(tried, b, {0.02 * n + 0.05, 0.07, false});
    if (n % 4 == 0) tried.drop_caches();
    both_step(plain, a, tried, b, n);
  }
}

// A cantilever that bends far over under its weight takes the exact tangent on the way to its
// equilibrium: the factor of that is made again with that, not with the one a step begins with.
TEST(State, SaysWithWhichTangentAFactorWasMade)
{
  Scene scene = test::needle_scenario({15, 2, 2, Vec3(0.15, 0.02, 0.02), 0.0});
  scene.needles.clear();
  scene.tissue.model = tissue::Model::corotational;
  scene.tissue.lag_tolerance = 1e-8;
  scene.tissue.materials = {{1e4, 0.4, 1000.0, 0.0, 0.0}};
  scene.tissue.boundary.fixed = {{"x0", 7}};
  scene.tissue.boundary.gravity = Vec3(0, 0, -9.81);
  scene.tissue.boundary.tractions = {
      {"x1", Vec3(0, 2.0, 0), core::parse_csv("time,factor\n0,0\n1,1\n", "pull.csv")}};
  scene.time.is_static = true;
  Model plain(scene, base::Comm(MPI_COMM_WORLD)), dropped(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(plain)->state, b = initial_state(dropped)->state;
  ASSERT_TRUE(a.tissue.factor);
  EXPECT_TRUE(a.tissue.factor->exact);
  for (int n = 1; n <= 4; ++n) {
    dropped.drop_caches();
    const core::TimeStep now{0.25 * n, 0.25, true};
    const auto one = advance(plain, a, now), other = advance(dropped, b, now);
    ASSERT_TRUE(one && other) << one.why() << other.why();
    a = one->state;
    b = other->state;
    ASSERT_TRUE(a.tissue.factor && b.tissue.factor);
    EXPECT_EQ(a.tissue.factor->exact, b.tissue.factor->exact) << n;
    EXPECT_EQ(one->report.linearisations, other->report.linearisations) << n;
    EXPECT_LE((a.tissue.u.value - b.tissue.u.value).norm(), 1e-7 * a.tissue.u.value.norm());
  }
}

}  // namespace
}  // namespace trocar::step
