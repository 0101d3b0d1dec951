#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/tip.hpp"

namespace trocar {
namespace {

using insertion::Phase;
using test::layered;

/// The channel waits at x = 3 cm until the force reaches `threshold`, and then goes on.
void expect_stop_at_border(const step::Scene& scenario, double threshold)
{
  const test::Run run = test::run(scenario);
  int waiting = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const auto& state = run.states[n - 1].insertions[0];
    const bool at_border = state.tip.threshold == threshold && state.phase == Phase::inserted;
    if (!at_border) continue;
    ++waiting;
    EXPECT_NEAR(state.path.vertex.back().x(), 0.03, 1e-12);
    const double force = run.reports[n].needles[0].coupling.tip_force;
    EXPECT_LE(force, threshold + 1e-12);
    if (run.states[n].insertions[0].path.length() > state.path.length()) {
      EXPECT_NEAR(force, threshold, 1e-12);
    }
  }
  EXPECT_GT(waiting, 3);
  EXPECT_EQ(run.states.back().insertions[0].tip.punctures, 2);  // the surface and the border
  EXPECT_GT(run.states.back().insertions[0].path.vertex.back().x(), 0.035);
}

TEST(Layers, EachHasItsOwnThresholdCuttingForceAndFriction)
{
  step::Scene scenario = layered();
  scenario.insertion.puncture.volume = {0.1, 1.0};
  expect_stop_at_border(scenario, 1.0);
  const test::Run run = test::run(scenario);
  const auto& last = run.reports[120];
  const auto& state = run.states[120].insertions[0];
  ASSERT_GT(state.path.vertex.back().x(), 0.032);
  EXPECT_NEAR(last.needles[0].coupling.tip_force, 0.2, 1e-12);
}

TEST(Layers, ATaggedSurfaceInsideATissueIsAMembrane)
{
  step::Scene scenario = layered();
  mesh::Mesh& mesh = scenario.mesh;
  mesh::SurfaceGroup capsule;
  capsule.name = "capsule";
  for (const mesh::Tet& tet : mesh.tets)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      const mesh::Face face{tet[(opposite + 1) % 4], tet[(opposite + 2) % 4],
                            tet[(opposite + 3) % 4]};
      const bool on_border = std::all_of(face.begin(), face.end(), [&](int node) {
        return std::abs(mesh.x[static_cast<std::size_t>(node)].x() - 0.03) < 1e-9;
      });
      if (on_border) capsule.faces.push_back(face);
    }
  mesh.surfaces.push_back(capsule);
  mesh.volumes = {"soft"};
  std::fill(mesh.region.begin(), mesh.region.end(), 0);
  scenario.tissue.materials.resize(1);
  scenario.insertion.friction.resize(1);
  scenario.insertion.tip.cutting = {0.05};
  scenario.insertion.puncture.volume = {0.1};
  scenario.insertion.puncture.surface.assign(mesh.surfaces.size(), -1.0);
  scenario.insertion.puncture.surface.back() = 0.6;
  expect_stop_at_border(scenario, 0.6);
}

}  // namespace
}  // namespace trocar
