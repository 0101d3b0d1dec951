#include "step/time_stepper.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "step/archive.hpp"
#include "support/scene.hpp"

namespace trocar::step {
namespace {

struct Listener : Observer
{
  void accepted(const State& state, const StepReport& /*report*/, const Progress& at) override
  {
    times.push_back(state.t);
    progress.push_back(at);
  }
  void rejected(double t, const std::string& /*why*/) override { refused.push_back(t); }

  std::vector<double> times, refused;
  std::vector<Progress> progress;
};

/// A block of 4 cm, light enough to be in balance always, whose top is pressed down by `depth`
/// within a second, in two steps of at most so many linearisations.
Scene pressed(double depth, int most = 50)
{
  Scene scene = test::needle_scenario({2, 2, 2, Vec3(0.04, 0.04, 0.04), 0.0});
  scene.needles.clear();
  scene.tissue.model = tissue::Model::neo_hookean;
  scene.tissue.materials = {{5000.0, 0.3, 1e-6, 0.0, 0.0}};
  scene.tissue.boundary.displacements = {
      {"z1", Vec3(0, 0, -depth), core::parse_csv("time,factor\n0,0\n1,1\n", "press.csv")}};
  scene.time.newton_max = most;
  scene.time.step = scene.time.asked = 0.5;
  scene.time.end = 1.0;
  return scene;
}

// Whole steps that nothing is wrong with are taken as they are.
TEST(TimeStepper, TakesWholeSteps)
{
  const Scene scene = pressed(0.004);
  Model simulation(scene, base::Comm(MPI_COMM_WORLD));
  Listener listener;
  TimeStepper stepper(simulation, listener);
  stepper.run(stepper.start());
  EXPECT_EQ(listener.times, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_TRUE(listener.refused.empty());
  EXPECT_EQ(listener.progress.back().nominal, 2);
  EXPECT_EQ(simulation.ledger.steps, 2);
}

// A step that is too long is taken in halves, these in halves again; the run is told which of them
// ends a whole step, and comes to the same equilibrium as one with short steps from the start.
TEST(TimeStepper, HalvesWhatIsRejected)
{
  const Scene scene = pressed(0.02, 3);
  Model simulation(scene, base::Comm(MPI_COMM_WORLD));
  Listener listener;
  TimeStepper stepper(simulation, listener);
  const State end = stepper.run(stepper.start());
  ASSERT_FALSE(listener.refused.empty());
  EXPECT_EQ(simulation.ledger.rejected_steps, static_cast<std::int64_t>(listener.refused.size()));
  EXPECT_EQ(listener.times.back(), 1.0);
  long whole = 0;
  for (std::size_t n = 1; n < listener.progress.size(); ++n) {
    EXPECT_GT(listener.times[n], listener.times[n - 1]);
    EXPECT_EQ(listener.progress[n].accepted, static_cast<int>(n));
    whole += listener.progress[n].whole ? 1 : 0;
    EXPECT_EQ(listener.progress[n].nominal, whole);
    EXPECT_EQ(listener.progress[n].whole, std::fmod(listener.times[n], 0.5) == 0.0);
  }
  EXPECT_EQ(whole, 2);

  Scene finer = pressed(0.02);
  finer.time.step = finer.time.asked = 1.0 / 32;
  const test::Run run = test::run(finer);
  const auto& u = run.states.back().tissue.u.value;
  EXPECT_LT((end.tissue.u.value - u).norm(), 1e-6 * u.norm());
}

/// Stops a run after so many whole steps, or only looks at it there.
struct Stopper final : Listener
{
  Stopper(Model& of, long after, bool ends) : model(&of), last(after), stops(ends) {}
  Wish wish() const override { return progress.empty() ? Wish::nothing : Wish::end; }
  bool goes_on(const State& state, const Progress& at) override
  {
    EXPECT_TRUE(at.whole);
    EXPECT_EQ(at.wish, Wish::end);
    whole.push_back(at.nominal);
    if (at.nominal != last) return true;
    saved = archived(state, model->space);
    place = at;
    model->drop_caches();
    return !stops;
  }

  Model* model;
  long last;
  bool stops;
  std::vector<long> whole;
  core::Archive saved;
  Progress place;
};

// A wish waits until a whole step has ended; and whether a run that has steps in halves on both
// sides of a checkpoint goes on from there or another one does is the same to the last bit.
TEST(TimeStepper, GoesOnFromBetweenHalvedSteps)
{
  Scene scene = pressed(0.02, 2);
  scene.time.step = scene.time.asked = 0.25;
  Model model(scene, base::Comm(MPI_COMM_WORLD));
  Stopper once(model, 2, false);
  TimeStepper stepper(model, once);
  const State end = stepper.run(stepper.start());
  EXPECT_EQ(once.whole, (std::vector<long>{1, 2, 3, 4}));
  ASSERT_FALSE(once.refused.empty());
  EXPECT_LT(once.refused.front(), 0.5);
  EXPECT_GT(once.refused.back(), 0.5);

  Model other(scene, base::Comm(MPI_COMM_WORLD));
  Stopper first(other, 2, true);
  TimeStepper until(other, first);
  until.run(until.start());
  EXPECT_EQ(first.times.back(), 0.5);
  Model fresh(scene, base::Comm(MPI_COMM_WORLD));
  Listener rest;
  TimeStepper from(fresh, rest);
  const State again = from.run(restored(first.saved, fresh.space), first.place);
  EXPECT_EQ(archived(again, fresh.space), archived(end, model.space));
  EXPECT_EQ(first.times.size() + rest.times.size(), once.times.size());
  EXPECT_EQ(rest.progress.back().accepted, once.progress.back().accepted);
}

// What cannot be reached in halves either ends the run with its reason and the time it came to.
TEST(TimeStepper, GivesUpWithTheReason)
{
  const Scene scene = pressed(0.05);  // through the bottom
  Model simulation(scene, base::Comm(MPI_COMM_WORLD));
  Listener listener;
  TimeStepper stepper(simulation, listener);
  const State start = stepper.start();
  try {
    stepper.run(start);
    FAIL() << "it was pressed through itself";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::solver);
    EXPECT_NE(std::string(failure.what()).find("the step was halved 8 times"), std::string::npos)
        << failure.what();
  }
  EXPECT_GT(listener.times.back(), 0.5);
}

}  // namespace
}  // namespace trocar::step
