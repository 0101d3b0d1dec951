#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scene.hpp"

// A bar that a moving wall meets (docs/theory.md section 14).
namespace trocar {
namespace {

using core::Vec3;

constexpr double young = 1e6, density = 1000.0, length = 0.1, side = 0.005, speed = 0.1;
constexpr int cells = 40;
const double c = std::sqrt(young / density);
const double force = young * side * side * speed / c;  ///< E A v/c
const double edge = length / cells;

/// Everything in the frame of the wall: it moves to the right with `speed` from 1 edge/c before the
/// bar, which rests. Poisson's ratio 0: a bar of one dimension.
step::Scene scene_of(bool second_order, double steps_per_edge)
{
  step::Scene scene;
  scene.mesh = test::block({cells, 1, 1, Vec3(length, side, side)});
  scene.tissue.model = tissue::Model::linear;
  scene.tissue.materials = {{young, 0.0, density, 0.0, 0.0}};
  contact::Obstacle wall{"wall"};
  wall.normal = Vec3::UnitX();
  const double gap = speed * 2.3 * edge / c;
  wall.origin = Vec3(-gap, 0, 0);
  wall.path = core::Csv{"wall", {"time", "x", "y", "z"}, {{0, 0, 0, 0}, {1, speed, 0, 0}}};
  scene.contact.obstacles = {wall};
  scene.contact.pairs = {{"wall", "x0", "wall"}};
  scene.time.second_order = second_order;
  scene.time.step = edge / c / steps_per_edge;
  scene.time.asked = scene.time.step;
  scene.time.end = std::ceil(2.6 * length / c / scene.time.step) * scene.time.step;
  scene.energy = true;
  return scene;
}

/// What a run says of the force on the wall.
struct Impact
{
  int phases = 0;         ///< times that the bar comes to touch
  double duration = 0.0;  ///< of the first one, in edge/c; the force above a twentieth of EAv/c
  double impulse = 0.0, plateau = 0.0;  ///< over those of the closed form; mean of the middle half
  double gain = 0.0;                    ///< largest gain of energy in a step over the kinetic one
};

Impact impact_of(const step::Scene& scene, const test::Run& run)
{
  Impact found;
  double begin = 0.0, end = 0.0;
  int middle = 0;
  bool touched = false;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const double f = -run.reports[n].contact[0].force.x();
    const bool touches = f > 0.0;
    if (touches && !touched && ++found.phases == 1) begin = run.states[n].t;
    if (f > 0.05 * force) end = run.states[n].t;
    touched = touches;
    found.impulse += f * scene.time.step / (2.0 * length / c * force);
    const double since = (run.states[n].t - begin) * c / length;
    if (touches && since > 0.5 && since < 1.5) {
      found.plateau += f / force;
      ++middle;
    }
    const step::EnergyAccount &e = run.states[n].energy, &before = run.states[n - 1].energy;
    const double kinetic = 0.5 * density * length * side * side * speed * speed;
    found.gain = std::max(found.gain, (before.rest() - e.rest()) / kinetic);
    EXPECT_GE(e.contact, before.contact - 1e-8 * force);  // the laws hold to 1e-9 m
  }
  found.duration = (end - begin) / (edge / c);
  found.plateau /= middle;
  return found;
}

TEST(BarImpact, TouchesOnceForAWaveThereAndBack)
{
  for (const bool second_order : {false, true})
    for (const double steps_per_edge : {1.0, 4.0, 10.0}) {
      SCOPED_TRACE(testing::Message() << second_order << ' ' << steps_per_edge);
      const step::Scene scene = scene_of(second_order, steps_per_edge);
      const test::Run run = test::run(scene);
      const Impact impact = impact_of(scene, run);
      EXPECT_EQ(impact.phases, 1);
      EXPECT_NEAR(impact.plateau, 1.0, 0.01);
      EXPECT_NEAR(impact.duration, 2.0 * cells, 3.0);
      EXPECT_NEAR(impact.impulse, 1.0, second_order && steps_per_edge > 1.0 ? 0.01 : 0.1);
      const double most = steps_per_edge > 1.0 ? 0.002 : 0.02;
      EXPECT_LT(impact.gain, second_order ? most : 1e-12);
      EXPECT_LE(run.ledger.repeated_steps, second_order ? 4 : 0);
    }
}

}  // namespace
}  // namespace trocar
