#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "constraint/system.hpp"
#include "step/rows.hpp"
#include "support/scene.hpp"

// A needle coupled along a line (docs/theory.md section 13).
namespace trocar {
namespace {

using core::Vec3;
using insertion::Placement;

/// A needle that goes 4 cm into a block in static steps of ¼ mm.
step::Scene along_line(bool quadratic, int cells, double jitter)
{
  test::BlockShape shape{3 * cells / 2, cells, cells, Vec3(0.06, 0.04, 0.04), jitter};
  shape.quadratic = quadratic;
  step::Scene scenario = test::needle_scenario(shape);
  scenario.insertion.placement.placement = Placement::line;
  scenario.insertion.line.kappa = quadratic ? 0.8 : 1.4;
  scenario.insertion.line.ring = quadratic ? 0.25 : 0.35;
  scenario.time.is_static = true;
  scenario.time.step = 0.0125;
  scenario.time.end = 2.0;
  return scenario;
}

/// The largest second difference of the shaft's friction over its final value.
double largest_jump(const test::Run& run)
{
  const auto friction = [&](std::size_t n) {
    return run.reports[n].needles[0].coupling.shaft_friction;
  };
  double largest = 0.0;
  for (std::size_t n = 5; n + 1 < run.reports.size(); ++n)
    largest = std::max(largest, std::abs(friction(n + 1) - 2.0 * friction(n) + friction(n - 1)));
  return largest / std::abs(friction(run.reports.size() - 1));
}

// Points that are born make the force jump, by up to 1 % of its final value; hats grow. Dry and
// viscous, on coarse meshes, with a rigid needle and a beam.
TEST(LineCoupling, ForceHasNoJumps)
{
  for (const bool quadratic : {false, true})
    for (const insertion::Friction& friction :
         {insertion::Friction{10.0, 10.0, 0.0}, insertion::Friction{0.0, 0.0, 500.0}})
      for (const needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
        step::Scene scenario = along_line(quadratic, 4, 0.2);
        scenario.insertion.friction = test::same(friction);
        scenario.needles[0].model = model;
        const double jump = largest_jump(test::run(scenario));
        EXPECT_LT(jump, 5e-4) << quadratic << friction.viscous << (model == needle::Model::beam);
        scenario.insertion.placement.placement = Placement::crossings;
        EXPECT_GT(largest_jump(test::run(scenario)), 2.0 * jump);
      }
}

/// Force on a needle that sticks along 4 cm of the axis of a block, offset by `beside`, and is
/// pushed by 10 µm. The block has `ny` and `nz` cells across.
double stuck_force(bool quadratic, int ny, int nz, const Vec3& beside = Vec3::Zero())
{
  step::Scene scenario = along_line(quadratic, 8, 0.0);
  test::BlockShape shape{12, ny, nz, Vec3(0.06, 0.04, 0.04), 0.0};
  shape.quadratic = quadratic;
  scenario.mesh = test::block(shape);
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.motion.entry = Vec3(0.0, 0.02, 0.02) + beside;
  needle.motion.inserted = 0.04;
  needle.motion.velocity = 1e-5 / scenario.time.step;
  needle.motion.depth = 0.05;
  scenario.insertion.friction = test::same({1e6, 1e6, 0.0});
  scenario.time.end = scenario.time.step;
  return test::run(scenario).reports.back().needles[0].coupling.shaft_friction;
}

// Ties decide nothing: on mesh edges, in the plane of faces and anywhere the force is the same, and
// a path moved by a nanometre holds the same.
TEST(LineCoupling, TiesDecideNothing)
{
  for (const bool quadratic : {false, true}) {
    const double on_edges = stuck_force(quadratic, 8, 8);
    EXPECT_NEAR(stuck_force(quadratic, 7, 8), on_edges, 0.02 * on_edges);  // in faces
    EXPECT_NEAR(stuck_force(quadratic, 7, 9), on_edges, 0.02 * on_edges);  // in neither
    EXPECT_NEAR(stuck_force(quadratic, 8, 8, {0.0, 1e-9, -1e-9}), on_edges, 1e-6 * on_edges);
    EXPECT_NEAR(stuck_force(quadratic, 7, 8, {0.0, 1e-9, -1e-9}), stuck_force(quadratic, 7, 8),
                1e-6 * on_edges);
  }
}

/// Condition number of W at a state, with every row divided by the root of its diagonal entry.
double condition(step::Model& model, const step::State& state, const core::TimeStep& now)
{
  constraint::Set set = std::move(step::coupling_rows(model, now, state).set);
  if (set.empty()) return 1.0;
  const auto linear = model.needles[0].linearise(state.needles[0], state.needles[0], now);
  const constraint::System system(std::move(set),
                                  {{linear.held, linear.factor, linear.free_increment}});
  auto at = model.tissue.linearise(state.tissue, state.tissue.u, now);
  solve::ComplianceReport report;
  core::MatX W = system.compliance(at->factor->compliance().block(system.probes(), report));
  const core::VecX scale = W.diagonal().cwiseSqrt().cwiseInverse();
  W = (scale.asDiagonal() * W * scale.asDiagonal()).eval();
  const core::VecX values = W.selfadjointView<Eigen::Lower>().eigenvalues();
  return values.maxCoeff() / values.minCoeff();
}

// The rows stay independent while hats grow from nothing.
TEST(LineCoupling, RowsStayIndependent)
{
  double worst = 0.0;
  for (const bool quadratic : {false, true})
    for (const Vec3& entry : {Vec3(0.0, 0.02, 0.02), Vec3(0.0, 0.0173, 0.0231)}) {
      step::Scene scenario = along_line(quadratic, 5, 0.0);
      scenario.needles[0].motion.entry = entry;
      step::Model model(scenario, base::Comm(MPI_COMM_WORLD));
      step::State state = step::initial_state(model)->state;
      for (int n = 1; n <= 160; ++n) {
        const core::TimeStep now{0.0125 * n, 0.0125, true};
        auto next = step::equilibrium(model, state, now);
        ASSERT_TRUE(next) << next.why();
        state = std::move(next->state);
        worst = std::max(worst, condition(model, state, now));
      }
    }
  EXPECT_LT(worst, 1000.0);
  EXPECT_GT(worst, 1.0);
  RecordProperty("worst", std::to_string(worst));
}

// Force and depth of friction that slips everywhere: τ · depth, also in two tissues and through the
// far side of the block.
TEST(LineCoupling, FrictionIsTauTimesDepth)
{
  step::Scene scenario = along_line(false, 5, 0.2);
  scenario.mesh.volumes = {"near", "far"};
  for (std::size_t t = 0; t < scenario.mesh.tets.size(); ++t)
    scenario.mesh.region[t] =
        mesh::corners(scenario.mesh, static_cast<int>(t))[0].x() > 0.021 ? 1 : 0;
  scenario.tissue.materials.push_back(scenario.tissue.materials[0]);
  scenario.insertion.friction = {{{1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}},
                                 {{0.4, 0.4, 0.0}, {0.4, 0.4, 0.0}}};
  scenario.needles[0].motion.length = 0.12;
  scenario.needles[0].motion.depth = 0.075;
  scenario.time.end = 4.0;
  const test::Run run = test::run(scenario);
  int slipping = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n) {
    const insertion::InsertionState& state = run.states[n].insertions[0];
    if (state.points.empty() || std::any_of(state.points.begin(), state.points.end(),
                                            [](const auto& p) { return p.stuck; }))
      continue;
    ++slipping;
    const core::MatX held = insertion::tributary_lengths(scenario.mesh, state);
    EXPECT_NEAR(held.sum(), run.reports[n].needles[0].depth, 1e-12);
    EXPECT_NEAR(run.reports[n].needles[0].coupling.shaft_friction,
                held.col(0).sum() + 0.4 * held.col(1).sum(), 1e-9);
  }
  EXPECT_GT(slipping, 200);
  EXPECT_NEAR(run.reports.back().needles[0].depth, 0.06, 1e-6);  // all of the block
}

// A tip that must cut gets as deep in short steps as in long ones, and hardly less deep than one
// that need not.
TEST(LineCoupling, ACuttingTipLosesNoDepth)
{
  for (const bool quadratic : {false, true}) {
    const auto depth = [&](double cutting, double step) {
      step::Scene scenario = along_line(quadratic, 4, 0.2);
      scenario.insertion.tip.cutting = {cutting};
      scenario.insertion.friction = test::same({5.0, 5.0, 0.0});
      scenario.time.step = step;
      return test::run(scenario).reports.back().needles[0].depth;
    };
    const double deep = depth(0.02, 0.05);
    EXPECT_NEAR(depth(0.02, 0.0125), deep, 0.005 * deep);
    EXPECT_NEAR(deep, depth(0.0, 0.05), 0.03 * deep);
    EXPECT_GT(deep, 0.035);
  }
}

// In and out ten times: the second cycle is the last, and nothing stays behind.
TEST(LineCoupling, CyclesDoNotDrift)
{
  for (const needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    step::Scene scenario = along_line(false, 5, 0.2);
    scenario.needles[0].model = model;
    std::string rows = "time,x,y,z\n0,-0.08,0.0173,0.0231\n";
    for (int cycle = 0; cycle < 5; ++cycle) {
      rows += std::to_string(2 * cycle + 1) + ",-0.05,0.0173,0.0231\n";
      rows += std::to_string(2 * cycle + 2) + ",-0.085,0.0173,0.0231\n";
    }
    scenario.needles[0].motion.trajectory = core::parse_csv(rows, "cycles.csv");
    scenario.insertion.friction = test::same({3.0, 2.0, 0.0});
    scenario.time.is_static = false;
    scenario.time.step = 0.02;
    scenario.time.end = 10.0;
    const test::Run run = test::run(scenario);
    const auto &second = run.reports[150].needles[0], &last = run.reports[450].needles[0];
    EXPECT_GT(second.base.force.norm(), 0.04);
    EXPECT_LT((last.base.force - second.base.force).norm(), 1e-6 * second.base.force.norm());
    EXPECT_NEAR(last.depth, second.depth, 1e-9);
    EXPECT_TRUE(run.states.back().insertions[0].points.empty());
    const core::VecX& u = run.states.back().tissue.u.value;
    const double left = u.size() ? u.cwiseAbs().maxCoeff() : 0.0;
    EXPECT_LT(base::Comm(MPI_COMM_WORLD).max(left), 1e-6);
  }
}

}  // namespace
}  // namespace trocar
