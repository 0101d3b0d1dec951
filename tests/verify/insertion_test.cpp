#include <gtest/gtest.h>

#include <cmath>

#include "constraint/reduce.hpp"
#include "support/body.hpp"
#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using insertion::Placement;

const test::BlockShape plain{6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.0};
const test::BlockShape distorted{8, 5, 5, Vec3(0.06, 0.04, 0.04), 0.25};

bool all_slip(const insertion::InsertionState& state)
{
  return !state.points.empty() && std::none_of(state.points.begin(), state.points.end(),
                                               [](const auto& p) { return p.stuck; });
}

// F = τ · depth to round-off in every step in which all points slip, on any mesh and placement.
TEST(Friction, IsTauTimesDepthWheneverEverythingSlips)
{
  for (const auto& shape : {plain, distorted})
    for (const insertion::PlacementSettings& placement : {insertion::PlacementSettings{},
                                                          {Placement::crossings, 0.005, 0.0},
                                                          {Placement::spacing, 0.0047, 0.3},
                                                          {Placement::spacing, 0.012, 0.3}}) {
      driver::Scenario scenario = test::needle_scenario(shape);
      scenario.insertion.placement = placement;
      // One step advances 0.5 mm; τ ℓ W_kk is about 1 N/m * 0.01 m * 3e-3 m/N = 3e-5 m.
      scenario.needles[0].motion.velocity = 0.025;
      scenario.insertion.friction = test::same({1.0, 1.0, 0.0});
      scenario.time.end = 1.5;
      const test::Run run = test::run(scenario);
      int slipping = 0;
      for (std::size_t n = 1; n < run.states.size(); ++n) {
        if (!all_slip(run.states[n].insertions[0])) continue;
        ++slipping;
        const auto& needle = run.reports[n].needles[0];
        EXPECT_NEAR(needle.coupling.shaft_friction, 1.0 * needle.depth, 1e-9);
      }
      EXPECT_GT(slipping, 20);
    }
}

TEST(Friction, OnlyDissipates)
{
  driver::Scenario scenario = test::needle_scenario(distorted);
  scenario.tissue.model = tissue::Model::corotational;
  scenario.needles[0].motion.hold = 0.2;
  scenario.needles[0].motion.withdraw_velocity = 0.03;
  scenario.insertion.friction = test::same({14.0, 9.0, 0.0});
  scenario.time.end = 4.0;
  double worst = 0.0, total = 0.0;
  for (const auto& report : test::run(scenario).reports) {
    worst = std::max(worst, report.needles[0].coupling.friction_work);
    total += report.needles[0].coupling.friction_work;
  }
  EXPECT_LE(worst, 1e-12);
  EXPECT_LT(total, -1e-4);
}

// From rest a point holds up to the static limit, slipping it keeps the dynamic one: pulled out
// slowly, the needle breaks away at τ_s · depth and goes on at τ_d · depth.
TEST(Friction, BreaksAwayAtTheStaticLimit)
{
  driver::Scenario scenario = test::needle_scenario(plain);
  needle::BaseMotion& motion = scenario.needles[0].motion;
  motion.inserted = motion.depth = 0.04;
  motion.withdraw_velocity = 0.001;
  scenario.insertion.friction = test::same({4.0, 2.0, 0.0});
  scenario.time.step = 0.01;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  double peak = 0.0;
  for (const auto& report : run.reports)
    peak = std::max(peak, -report.needles[0].coupling.shaft_friction);
  const auto& last = run.reports.back().needles[0];
  // Points break away one after another, so the sum peaks below the sum of the static limits.
  EXPECT_GT(peak, 1.2 * 2.0 * 0.04);
  EXPECT_LE(peak, 4.0 * 0.04 + 1e-9);
  ASSERT_TRUE(all_slip(run.states.back().insertions[0]));
  EXPECT_NEAR(-last.coupling.shaft_friction, 2.0 * last.depth, 1e-9);
}

// A dashpot per length: F = b v depth once the tissue moves no more, in proportion to velocity, and
// it relaxes when the needle stops.
TEST(Friction, ViscousForceFollowsVelocityAndRelaxes)
{
  double per_velocity = 0.0;
  for (double velocity : {0.002, 0.004}) {
    driver::Scenario scenario = test::needle_scenario(distorted);
    needle::BaseMotion& motion = scenario.needles[0].motion;
    motion.inserted = 0.03;
    motion.velocity = velocity;
    motion.depth = 0.031;
    motion.hold = 1e9;
    scenario.insertion.friction = test::same({0.0, 0.0, 200.0});
    scenario.time.step = 2e-5 / velocity;
    scenario.time.end = 0.0008 / velocity;
    const test::Run run = test::run(scenario);
    const auto& last = run.reports.back().needles[0];
    // The tissue still creeps after 0.8 mm, by a few per cent of the needle's speed.
    EXPECT_NEAR(last.coupling.shaft_friction / (200.0 * velocity * last.depth), 1.0, 0.1);
    if (per_velocity > 0.0) {
      EXPECT_NEAR(last.coupling.shaft_friction / velocity / per_velocity, 1.0, 0.1);
    }
    per_velocity = last.coupling.shaft_friction / velocity;
    for (const auto& report : run.reports)
      EXPECT_LE(report.needles[0].coupling.friction_work, 1e-15);
    scenario.time.end = 0.001 / velocity + 1.0;
    EXPECT_LT(std::abs(test::run(scenario).reports.back().needles[0].coupling.shaft_friction),
              0.01 * last.coupling.shaft_friction);
  }
}

// Static friction only: a point that slipped has no axial row, one at rest has; the rows of a step
// do not change while it is iterated.
TEST(Friction, MayBeStaticOnly)
{
  for (driver::Analysis analysis : {driver::Analysis::dynamic, driver::Analysis::equilibrium}) {
    driver::Scenario scenario = test::needle_scenario(plain);
    scenario.needles[0].model = needle::Model::beam;
    scenario.time.analysis = analysis;
    scenario.time.newton_max = 20;
    scenario.needles[0].motion.hold = 0.2;
    scenario.needles[0].motion.withdraw_velocity = 0.02;
    scenario.insertion.friction = test::same({5.0, 0.0, 0.0});
    scenario.time.end = 3.0;
    const test::Run run = test::run(scenario);
    EXPECT_EQ(run.reports[75].needles[0].coupling.shaft_friction, 0.0);  // advancing: all slip
    double peak = 0.0;
    for (const auto& report : run.reports)
      peak = std::max(peak, -report.needles[0].coupling.shaft_friction);
    EXPECT_GT(peak, 0.01);  // from rest it holds first
  }
}

TEST(Friction, MayDifferOnWithdrawal)
{
  driver::Scenario scenario = test::needle_scenario(plain);
  scenario.insertion.friction = {{{2.0, 2.0, 0.0}, {0.5, 0.5, 0.0}}};
  scenario.needles[0].motion.withdraw_velocity = 0.02;
  scenario.time.end = 3.0;
  const test::Run run = test::run(scenario);
  int slipping = 0;
  for (std::size_t n = 110; n < run.states.size(); ++n) {
    if (!all_slip(run.states[n].insertions[0])) continue;
    ++slipping;
    const auto& needle = run.reports[n].needles[0];
    EXPECT_NEAR(needle.coupling.shaft_friction, -0.5 * needle.depth, 1e-9);
  }
  EXPECT_GT(slipping, 20);
}

TEST(Friction, EtaIsThatPartOfSticking)
{
  // One point, one step: λ_η = η λ_stick with the lateral forces held; they shift it a little.
  const auto axial = [](double eta) {
    driver::Scenario scenario = test::needle_scenario(plain);
    scenario.needles[0].motion.inserted = 0.004;
    scenario.insertion.placement = {Placement::spacing, 0.005, 0.3};
    scenario.insertion.eta = eta;
    scenario.time.end = 0.02;
    return test::run(scenario).reports.back().needles[0].coupling.shaft_friction;
  };
  const double stick = axial(1.0 - 1e-12);
  EXPECT_GT(stick, 1e-3);
  EXPECT_NEAR(axial(0.3), 0.3 * stick, 0.1 * 0.3 * stick);
}

// What the holder puts in is what the tissue feels. The tissue's side is taken from its own
// unbalanced nodal forces, which only the rows can balance.
TEST(Balance, ActionEqualsReaction)
{
  for (needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    driver::Scenario scenario = test::needle_scenario(distorted);
    scenario.needles[0].model = model;
    const base::Comm comm(MPI_COMM_WORLD);
    driver::Simulation simulation(scenario, comm);
    driver::State state = *simulation.initial_state().state;
    double worst = 0.0, largest = 0.0;
    for (int n = 1; n <= 60; ++n) {
      const core::TimeStep now{0.02 * n, 0.02, false};
      const driver::StepResult result = simulation.step(state, now);
      ASSERT_TRUE(result.state) << result.why;
      double scale = 0.0;
      const fem::GlobalField unbalanced = simulation.space().gather(
          simulation.tissue().residual(state.tissue, result.state->tissue.u, now, scale));
      Vec3 on_tissue = Vec3::Zero();
      for (int node = 0; node < scenario.mesh.node_count(); ++node)
        on_tissue -= unbalanced.node(node);
      worst = std::max(worst, (result.report.needles[0].base.force - on_tissue).norm());
      largest = std::max(largest, on_tissue.norm());
      state = *result.state;
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(worst, 1e-10 * largest);
  }
}

// The same in an iterated static state of a corotational body under its weight.
TEST(Balance, ActionEqualsReactionInEquilibrium)
{
  for (needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    driver::Scenario scenario = test::needle_scenario(distorted);
    scenario.needles[0].model = model;
    scenario.time.analysis = driver::Analysis::equilibrium;
    scenario.tissue.model = tissue::Model::corotational;
    scenario.tissue.boundary.gravity = Vec3(0, 0, -9.81);
    scenario.needles[0].motion.inserted = 0.03;
    const base::Comm comm(MPI_COMM_WORLD);
    driver::Simulation simulation(scenario, comm);
    const driver::StepResult start = simulation.initial_state();
    ASSERT_TRUE(start.state) << start.why;
    double scale = 0.0;
    const fem::GlobalField unbalanced = simulation.space().gather(simulation.tissue().residual(
        simulation.tissue().at_rest(), start.state->tissue.u, {0, 1, true}, scale));
    Vec3 on_tissue = Vec3::Zero();
    for (int node = 0; node < scenario.mesh.node_count(); ++node)
      on_tissue -= unbalanced.node(node);
    const Vec3 needle = start.report.needles[0].base.force;
    EXPECT_GT(needle.norm(), 1e-3);
    EXPECT_LT((on_tissue - needle).norm(), 1e-6 * needle.norm());
  }
}

// A needle row whose nodes are all prescribed has no force; its gap stays and statics converge.
TEST(Balance, RowsOnPrescribedNodesAreLeftAlone)
{
  driver::Scenario scenario = test::needle_scenario(plain);
  scenario.time.analysis = driver::Analysis::equilibrium;
  scenario.tissue.boundary.fixed = {{"z0", 7}, {"x0", 7}};
  scenario.needles[0].motion.entry = Vec3(0, 0.02, 0.02);
  scenario.needles[0].motion.inserted = 0.03;
  scenario.needles[0].motion.trajectory =
      core::parse_csv("time,x,y,z\n0,-0.05,0.02,0.02\n1,-0.05,0.021,0.02\n", "aside.csv");
  scenario.time.end = 0.04;
  const test::Run run = test::run(scenario);
  EXPECT_LT(run.reports.back().rank, run.reports.back().rows);
  EXPECT_GT(run.reports.back().needles[0].base.force.norm(), 1e-4);
}

TEST(Withdrawal, LeavesNoPointAndReturnsTheTissue)
{
  for (needle::Model model : {needle::Model::rigid, needle::Model::beam}) {
    driver::Scenario scenario = test::needle_scenario(distorted);
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
  driver::Scenario scenario = test::needle_scenario(plain);
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
  driver::Scenario scenario = test::needle_scenario(distorted);
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
  driver::Scenario scenario = test::needle_scenario(plain);
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

// W is symmetric, positive semidefinite and the dense H A⁻¹ Hᵀ.
TEST(ConstraintProblem, WIsTheDenseProduct)
{
  driver::Scenario scenario = test::needle_scenario(distorted);
  scenario.needles[0].model = needle::Model::beam;
  tissue::TissueSettings settings = scenario.tissue;
  test::Body body(distorted, settings);
  const mesh::Locator locator(body.mesh);
  insertion::InsertionSettings coupling = scenario.insertion;
  coupling.placement.merge = 0.0;
  const insertion::Insertion insertion(body.mesh, locator, coupling);
  scenario.needles[0].motion.inserted = 0.04;
  const needle::Needle needle(scenario.needles[0]);
  insertion::InsertionState state = insertion.start(needle);
  const fem::GlobalField u{core::VecX::Zero(3 * body.mesh.node_count())};
  constraint::Set set;
  insertion.add_rows(state, needle.initial().shaft, insertion::Deformed(body.mesh, locator, u), 0,
                     0.02, set);
  const double h = 0.02;
  const core::TimeStep now{h, h, false};
  const tissue::TissueState rest = body.tissue.at_rest();
  const auto motion = body.tissue.free_motion(rest, rest.u, now);
  const auto linear = needle.linearise(needle.initial(), needle.initial(), now);
  const solve::Probes probes = set.probes();
  solve::ComplianceReport report;
  const core::MatX C = body.tissue.compliance().block(probes, report);
  const law::Problem problem =
      constraint::reduce(set, C, body.tissue.at(probes, motion, rest.u),
                         {{linear.held, linear.factor, linear.free_increment}});

  const auto& material = settings.materials[0];
  core::MatX A = test::dense_operator(body.mesh, material, 1.0 + material.rayleigh_stiffness / h,
                                      1.0 / (h * h));
  test::fix_dense(A, body.tissue.fixed(), body.mesh.node_count());
  core::MatX H = core::MatX::Zero(set.size(), A.rows());
  core::MatX H_n = core::MatX::Zero(set.size(), needle.dofs());
  for (int i = 0; i < set.size(); ++i) {
    const auto& row = set.rows()[static_cast<std::size_t>(i)];
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k)
        if (!body.tissue.fixed().fixed(row.anchor.node[static_cast<std::size_t>(a)], k))
          H(i, 3 * row.anchor.node[static_cast<std::size_t>(a)] + k) +=
              row.anchor.weight[a] * row.direction[k];
    for (const auto& [dof, value] : row.lever) H_n(i, dof) += value;
  }
  const Eigen::Index free = needle.dofs() - 6;
  const core::MatX A_n = linear.A.bottomRightCorner(free, free);
  const core::MatX dense = H * A.llt().solve(H.transpose()) +
                           H_n.rightCols(free) * A_n.llt().solve(H_n.rightCols(free).transpose());
  const core::MatX& W = problem.W;
  EXPECT_LT((W - dense).norm(), 1e-10 * dense.norm());
  EXPECT_EQ((W - W.transpose()).norm(), 0.0);
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<core::MatX>(W).eigenvalues()[0], -1e-12 * W.norm());
}

// Table 1 of the needle paper: rows of a path of 15 cm at its six spacings.
TEST(PaperBeam, RowCountsOfTableOne)
{
  for (const auto& [spacing, rows] : {std::pair{0.01, 32},
                                      {0.005, 62},
                                      {0.002, 152},
                                      {0.001, 302},
                                      {0.0007, 430},
                                      {0.0004, 752}}) {
    const mesh::Mesh mesh = test::block({49, 5, 5, Vec3(0.15, 0.02, 0.02)});
    const mesh::Locator locator(mesh);
    const insertion::Insertion insertion(
        mesh, locator, {{Placement::spacing, spacing, 0.3}, test::same({}), 0.0, 1e-9});
    needle::NeedleSettings settings;
    settings.section = {0.0005, 0.0, 2e11, 0.3};
    settings.motion.entry = Vec3(0, 0.0093, 0.0107);
    settings.motion.length = 0.2;
    settings.motion.inserted = 0.15;
    const needle::Needle needle(settings);
    insertion::InsertionState state = insertion.start(needle);
    const fem::GlobalField u{core::VecX::Zero(3 * mesh.node_count())};
    constraint::Set set;
    insertion.add_rows(state, needle.initial().shaft, insertion::Deformed(mesh, locator, u), 0,
                       0.02, set);
    EXPECT_EQ(set.size(), rows);
  }
}

// A rejected step leaves no trace: trying an impossible step in between changes nothing.
TEST(State, ARejectedStepLeavesNoTrace)
{
  driver::Scenario scenario = test::needle_scenario(distorted);
  scenario.tissue.model = tissue::Model::corotational;
  const base::Comm comm(MPI_COMM_WORLD);
  driver::Simulation plain_run(scenario, comm), tried(scenario, comm);
  driver::State a = *plain_run.initial_state().state, b = *tried.initial_state().state;
  for (int n = 1; n <= 20; ++n) {
    const core::TimeStep now{0.02 * n, 0.02, false};
    tried.step(b, {0.02 * n + 5.0, 5.0, false});  // far too long; accepted or not, it is dropped
    a = *plain_run.step(a, now).state;
    b = *tried.step(b, now).state;
  }
  EXPECT_LT((a.tissue.u.value - b.tissue.u.value).norm(), 1e-14);
  EXPECT_EQ(a.insertions[0].points.size(), b.insertions[0].points.size());
}

// Iterating the linearisation changes a bent corotational step a little and then nothing.
TEST(Newton, IteratedStepsBalanceTheTrueForces)
{
  driver::Scenario scenario = test::needle_scenario(plain);
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
  driver::Scenario scenario = test::needle_scenario(distorted);
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
