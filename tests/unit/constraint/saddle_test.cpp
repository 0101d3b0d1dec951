#include "constraint/saddle.hpp"

#include <gtest/gtest.h>

#include "law/solve.hpp"
#include "support/body.hpp"
#include "support/dense.hpp"

// The three ways to a saddle point against the dense solution of the same equations.
namespace trocar::constraint {
namespace {

using core::MatX;
using core::VecX;

tissue::TissueSettings gel()
{
  tissue::TissueSettings settings;
  settings.model = tissue::Model::corotational;
  settings.tangent = tissue::Tangent::rotated;
  settings.lag_tolerance = 1e-8;
  settings.materials = {{4000.0, 0.3, 1000.0, 0.0, 0.01}};
  settings.boundary.fixed = {{"z0", 7}};
  settings.boundary.gravity = Vec3(0.0, 3.0, -9.81);
  return settings;
}

Row row_at(const std::vector<int>& nodes, const Vec3& direction, double gap)
{
  Row row;
  const auto count = static_cast<Eigen::Index>(nodes.size());
  row.tissue = {
      {{nodes, VecX::Constant(count, 1.0 / static_cast<double>(count))}, direction.normalized()}};
  row.gap = gap;
  return row;
}

/// Two bilateral rows and two of friction, one of which slips.
Set some_rows(const mesh::Mesh& mesh)
{
  Set set;
  const std::vector<int> top = mesh::group_nodes(mesh, "z1");
  set.add(row_at({top[0], top[1]}, Vec3(1, 2, 0), 2e-4));
  set.add(row_at({top[2]}, Vec3(0, 1, 1), -1e-4));
  for (double bound : {1e3, 1e-4})
    set.add(row_at({top[3], top[4], top[5]}, Vec3(1, 0, bound), 3e-4), law::Law::box(bound),
            set.next_point());
  set.couplings() = {{2, 3, 0.01}, {2, 2, 0.02}, {3, 3, 0.02}};
  return set;
}

/// A block that is turned about its foot by some degrees, linearised there with the factor of the
/// block at rest.
struct Turned
{
  explicit Turned(bool with_rows, const Set* rows = nullptr)
      : body({4, 3, 3, Vec3(0.1, 0.08, 0.08), 0.2}, gel()),
        rest(tissue::at_rest(body.space)),
        set(rows        ? *rows
            : with_rows ? some_rows(body.mesh)
                        : Set()),
        system(set, {}),
        laws(system, settings, report)
  {
    const core::TimeStep now{0.02, 0.02, false};
    (void)body.tissue.linearise(rest, rest.u, now);
    fem::OwnedField iterate = test::nodal(body, [](const Vec3& X) -> Vec3 {
      return core::rotation_exp(Vec3(0.0, 3.0 * X.z(), 0.0)) * X - X;
    });
    body.tissue.fixed().clear(iterate);
    at = *body.tissue.linearise(rest, iterate, now, {}, true);
  }

  int dofs() const { return 3 * body.mesh.node_count(); }
  VecX whole(const fem::OwnedField& field) { return body.space.gather(field).value; }

  /// A by its products, with unit columns on fixed dofs.
  MatX dense_operator()
  {
    MatX A = MatX::Identity(dofs(), dofs());
    for (int node = 0; node < body.mesh.node_count(); ++node)
      for (int axis = 0; axis < 3; ++axis) {
        if (body.tissue.fixed().fixed(node, axis)) continue;
        fem::OwnedField unit = body.space.zero();
        const int local = body.space.owned_local(node);
        if (local >= 0) unit.node(local)[axis] = 1.0;
        fem::OwnedField column = at.product(unit);
        body.tissue.fixed().clear(column);
        A.col(3 * node + axis) = whole(column);
      }
    return A;
  }

  /// H over all dofs, zero where they are fixed.
  MatX dense_rows()
  {
    MatX H = MatX::Zero(set.size(), dofs());
    for (int i = 0; i < set.size(); ++i) {
      for (const TissueTerm& term : set.rows()[static_cast<std::size_t>(i)].tissue)
        for (std::size_t a = 0; a < term.anchor.node.size(); ++a)
          H.block<1, 3>(i, 3 * term.anchor.node[a]) +=
              term.anchor.weight[static_cast<Eigen::Index>(a)] * term.direction.transpose();
    }
    return H;
  }

  test::Body body;
  tissue::TissueState rest;
  Set set;
  System system;
  LawSettings settings{{law::Method::automatic, law::Norm::residual, 1e-13, 100}, {}, &ledger};
  LawReport report;
  core::Ledger ledger;
  Laws laws;
  solve::Linearisation at;
};

/// What the equations have for an answer, all of it dense.
struct Answer
{
  VecX u, lambda;

  /// `C`: of another operator, the laws' (paper); empty: of A itself.
  explicit Answer(Turned& scene, const MatX& W_of_laws = {})
  {
    const MatX A = scene.dense_operator(), H = scene.dense_rows();
    const VecX r = scene.whole(scene.at.residual), base = scene.whole(scene.at.base);
    const VecX free = base + VecX(test::solved(A, r));
    u = free;
    if (scene.system.empty()) return;
    const MatX own = scene.system.compliance(
        MatX::Zero(scene.system.probes().size(), scene.system.probes().size()));
    law::Problem problem = scene.system.problem(
        W_of_laws.size() > 0 ? W_of_laws : H * test::solved(A, H.transpose()) + own,
        VecX::Zero(scene.system.probes().size()));
    problem.g += H * (free - scene.whole(scene.at.iterate));
    lambda = law::solve(problem, scene.settings.solver).lambda;
    u += VecX(test::solved(A, H.transpose() * lambda));
  }
};

void expect_equal(Turned& scene, const Outcome<Saddle>& found, const Answer& answer, double part)
{
  ASSERT_TRUE(found) << found.why();
  const VecX moved = answer.u - scene.whole(scene.at.iterate);
  EXPECT_LT((scene.whole(found->u) - answer.u).norm(), part * moved.norm());
  if (scene.system.empty()) return;
  EXPECT_LT((found->multipliers.lambda - answer.lambda).norm(), part * answer.lambda.norm());
  EXPECT_EQ(std::abs(answer.lambda[3]), 1e-4);  // it slips
  EXPECT_LT(std::abs(answer.lambda[2]), 1e3);   // it holds
}

TEST(Saddle, DirectIsTheDenseSolution)
{
  for (bool rows : {false, true}) {
    Turned scene(rows);
    ASSERT_TRUE(scene.at.refactor());
    EXPECT_FALSE(scene.at.lagged());
    expect_equal(scene, direct(scene.laws, scene.at, scene.system.starts()), Answer(scene), 1e-10);
    EXPECT_EQ(scene.report.passes, 1);
  }
}

TEST(Saddle, ProjectedCgIsTheDenseSolutionWithAnOlderFactor)
{
  for (bool rows : {false, true}) {
    Turned scene(rows);
    ASSERT_TRUE(scene.at.lagged());
    const int version = scene.at.factor->version();
    const Answer answer(scene);
    expect_equal(scene, projected_cg(scene.laws, scene.at, scene.system.starts(), 1e-10), answer,
                 1e-8);
    EXPECT_EQ(scene.at.factor->version(), version);
    EXPECT_GT(scene.report.passes, 2);
    EXPECT_EQ(scene.at.factor->age().last_sweeps, scene.report.passes);
  }
}

// From the answer's own multipliers as well as from none.
TEST(Saddle, ProjectedCgGoesOnFromMultipliers)
{
  Turned scene(true);
  const Answer answer(scene);
  expect_equal(scene, projected_cg(scene.laws, scene.at, answer.lambda, 1e-10), answer, 1e-8);
}

// What is asked for better than round-off has it never leads to with the older factor.
TEST(Saddle, ProjectedCgMakesAFactorOfItsOwnWhereItDoesNotLeadOn)
{
  for (bool rows : {false, true}) {
    Turned scene(rows);
    scene.at.least = 0.0;
    const int version = scene.at.factor->version();
    const Answer answer(scene);
    expect_equal(scene, projected_cg(scene.laws, scene.at, scene.system.starts(), 0.0), answer,
                 1e-9);
    EXPECT_EQ(scene.at.factor->version(), version + 1);
    EXPECT_FALSE(scene.at.lagged());
  }
}

// The paper's way: the laws with the compliance of the older factor, the tissue with the operator
// itself; by how much the gaps of held rows are then off is told.
TEST(Saddle, PaperMeetsTheLawsWithTheOlderCompliance)
{
  Turned scene(true);
  solve::ComplianceReport unused;
  const MatX C = scene.at.factor->compliance().block(scene.system.probes(), unused);
  const Answer answer(scene, scene.system.compliance(C));
  const SaddleSettings settings{true, true, 1e-11};
  const auto found = solve_saddle(scene.laws, scene.at, scene.system.starts(), settings);
  expect_equal(scene, found, answer, 1e-8);
  const VecX moved = answer.u - scene.whole(scene.at.iterate);
  const VecX gap = scene.dense_rows() * moved + VecX(Eigen::Vector4d(2e-4, -1e-4, 3e-4, 3e-4));
  const double open = std::max(std::abs(gap[0]), std::abs(gap[1]));
  EXPECT_GT(open, 1e-7);
  EXPECT_GE(scene.report.leftover_gap, open * (1.0 - 1e-6));
  const Answer exact(scene);
  EXPECT_NEAR(scene.report.stale_error, (exact.u - answer.u).cwiseAbs().maxCoeff(),
              1e-6 * moved.norm());
}

// Rows that contradict each other are refused by every way.
TEST(Saddle, IsRefusedWhereTheLawsCannotBeMet)
{
  Set set;
  {
    Turned scene(false);
    const std::vector<int> top = mesh::group_nodes(scene.body.mesh, "z1");
    set.add(row_at({top[0]}, Vec3::UnitX(), 1e-3));
    set.add(row_at({top[0]}, Vec3::UnitX(), -1e-3));
  }
  Turned scene(true, &set);
  EXPECT_FALSE(projected_cg(scene.laws, scene.at, scene.system.starts(), 1e-10));
  Turned own(true, &set);
  ASSERT_TRUE(own.at.refactor());
  EXPECT_FALSE(direct(own.laws, own.at, own.system.starts()));
}

}  // namespace
}  // namespace trocar::constraint
