#include "constraint/system.hpp"
#include "support/dense.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/body.hpp"

namespace trocar::constraint {
namespace {

using core::MatX;
using core::VecX;

/// Numbers without a pattern, the same on every rank.
MatX numbers(Eigen::Index rows, Eigen::Index columns, double phase)
{
  return MatX::NullaryExpr(rows, columns, [=](Eigen::Index i, Eigen::Index j) {
    return std::sin(phase + 3.7 * static_cast<double>(i) + 1.3 * static_cast<double>(i * j + j));
  });
}

MatX spd(Eigen::Index n, double phase)
{
  const MatX B = numbers(n, n, phase);
  return B * B.transpose() + MatX::Identity(n, n);
}

Row tissue_row(std::vector<int> nodes, const VecX& weights, const Vec3& direction, double gap)
{
  Row row;
  row.tissue = {{{std::move(nodes), weights}, direction.normalized()}};
  row.gap = gap;
  return row;
}

/// Rows by hand: two on overlapping nodes with a body each, one of the first body alone, one that
/// takes hold of a wide probe.
Set hand_made()
{
  Set set;
  Row a = tissue_row({9, 4, 7, 12}, Eigen::Vector4d(0.1, 0.2, 0.0, 0.7), Vec3(1, 2, -1), 1e-3);
  a.body = 0;
  a.on_body = {{1, 0.5}, {4, -0.25}, {1, 0.125}};  // coefficients of one dof add up
  Row b = tissue_row({4, 30}, Eigen::Vector2d(0.4, 0.6), Vec3(0, 1, 3), -2e-3);
  b.body = 1;
  b.on_body = {{0, 2.0}, {2, -1.0}};
  b.compliance = 0.3;
  Row c;
  c.body = 0;
  c.on_body = {{2, 1.0}, {0, 4.0}};  // dofs 0 and 1 are held
  c.gap = 5e-4;
  Row d;
  d.distributed = {{set.add_functional(std::make_shared<solve::DistributedFunctional>())}};
  d.gap = -1e-4;
  for (const Row& row : {a, b, c, d}) set.add(row);
  set.couplings() = {{0, 2, 0.05}, {3, 3, 0.7}};
  return set;
}

/// H over the nodes 4, 9, 12, 30 and the wide probe, and H_n of both bodies, written out.
struct Dense
{
  Dense()
  {
    const Vec3 a = Vec3(1, 2, -1).normalized(), b = Vec3(0, 1, 3).normalized();
    H.row(0) << 0.2 * a.transpose(), 0.1 * a.transpose(), 0.7 * a.transpose(), 0, 0, 0, 0;
    H.row(1) << 0.4 * b.transpose(), 0, 0, 0, 0, 0, 0, 0.6 * b.transpose(), 0;
    H(3, 12) = 1.0;
    levers[0](0, 1) = 0.625;
    levers[0](0, 4) = -0.25;
    levers[0](2, 0) = 4.0;
    levers[0](2, 2) = 1.0;
    levers[1].row(1) << 2.0, 0.0, -1.0;
    coupling(0, 2) = coupling(2, 0) = 0.05;
    coupling(3, 3) = 0.7;
  }
  MatX H = MatX::Zero(4, 13);
  std::vector<MatX> levers{MatX::Zero(4, 5), MatX::Zero(4, 3)};
  MatX coupling = MatX::Zero(4, 4);
};

/// Bodies of five dofs, two of them held, and of three; and what H_n A_n⁻¹ H_nᵀ is in all.
struct Bodies
{
  Bodies()
  {
    const Dense dense;
    for (const auto& [held, dofs] : {std::pair<int, Eigen::Index>{2, 5}, {0, 3}}) {
      const MatX A = spd(dofs - held, static_cast<double>(dofs));
      const MatX lever = dense.levers[all.size()].rightCols(dofs - held);
      all.push_back({held, core::Cholesky(A), numbers(dofs - held, 1, 0.2)});
      gives += lever * test::solved(A, lever.transpose());
      moved += lever * all.back().free_increment;
    }
  }
  std::vector<SmallBody> all;
  MatX gives = MatX::Zero(4, 4);
  VecX moved = VecX::Zero(4);
};

TEST(Rows, ProbeEveryNodeOfAnyWeightOnceAndInOrder)
{
  const Set set = hand_made();
  const solve::Probes probes = set.probes();
  EXPECT_EQ(probes.nodes, (std::vector<int>{4, 9, 12, 30}));
  EXPECT_EQ(probes.wide.size(), 1U);
  EXPECT_EQ(probes.size(), 13);
  EXPECT_TRUE(Set().empty());
  EXPECT_EQ(Set().probes().size(), 0);
}

TEST(Rows, AnchorsTakeTheMeanOfTheirNodes)
{
  const Set set = hand_made();
  const Vec3 mean =
      set.rows()[1].tissue.front().anchor.mean([](int node) -> Vec3 { return Vec3(node, 1, 0); });
  EXPECT_LT((mean - Vec3(0.4 * 4 + 0.6 * 30, 1, 0)).norm(), 1e-14);
}

TEST(System, IsTheDenseProductOfRowsWrittenOut)
{
  const Set set = hand_made();
  const Dense dense;
  const Bodies bodies;
  const MatX C = spd(13, 0.7);
  const VecX free = numbers(13, 1, 1.1);
  const System system(set, bodies.all);
  const law::Problem problem = system.problem(system.compliance(C), free);
  const MatX W = dense.H * C * dense.H.transpose() + bodies.gives + dense.coupling;
  const VecX gap = (VecX(4) << 1e-3, -2e-3, 5e-4, -1e-4).finished();
  const VecX g = gap + dense.H * free - bodies.moved;
  EXPECT_LT((problem.W - W).norm(), 1e-14 * W.norm());
  EXPECT_LT((problem.g - g).norm(), 1e-14 * g.norm());
  EXPECT_EQ((problem.W - problem.W.transpose()).norm(), 0.0);
}

// A body without free dofs, such as a rigid needle on its holder, adds nothing.
TEST(System, LeavesBodiesOutThatCannotMove)
{
  const Set set = hand_made();
  const Dense dense;
  const MatX C = spd(13, 0.7);
  SmallBody rigid;
  rigid.held = 5;
  const System system(set, {rigid, rigid});
  const law::Problem problem = system.problem(system.compliance(C), VecX::Zero(13));
  const MatX W = dense.H * C * dense.H.transpose() + dense.coupling;
  EXPECT_LT((problem.W - W).norm(), 1e-14 * W.norm());
}

TEST(System, GivesEveryRowItsOwnLaw)
{
  Set set;
  const auto row = [](int i) {
    Row one = tissue_row({i}, VecX::Ones(1), Vec3::UnitX(), 0.0);
    one.start = 0.1 * i;
    return one;
  };
  Row first = row(0);
  first.compliance = 1e-3;
  first.relative_compliance = 0.5;
  EXPECT_EQ(set.add(first), 0);
  EXPECT_EQ(set.add({row(1), row(2), row(3)}, law::Law::cone(0.3, 2.0), 10), 1);
  EXPECT_EQ(set.add(row(4), law::Law::follower(0, 0.7), set.next_point()), 4);
  const MatX C = spd(15, 0.4);
  const System system(set, {});
  const law::Problem problem = system.problem(system.compliance(C), VecX::Zero(15));
  ASSERT_EQ(problem.blocks.size(), 3U);
  EXPECT_EQ(problem.blocks[0].law, law::Law::zero());
  EXPECT_EQ(problem.blocks[1].law, law::Law::cone(0.3, 2.0));
  EXPECT_EQ(problem.blocks[2].law, law::Law::follower(0, 0.7));
  EXPECT_EQ(problem.blocks[1].end(), problem.blocks[2].first);
  EXPECT_EQ(problem.blocks[1].point, 10);
  EXPECT_EQ(problem.blocks[2].point, 11);
  EXPECT_LT((problem.start - 0.1 * VecX::LinSpaced(5, 0.0, 4.0)).norm(), 1e-15);
  EXPECT_EQ(problem.start, set.starts());
  EXPECT_NEAR(problem.compliance[0], 1e-3 + 0.5 * C(0, 0), 1e-15);
  EXPECT_EQ(problem.compliance[1], 0.0);
}

// What a row reads, it pushes with: work counted at the rows is that at the nodes.
TEST(System, ForcesAreTheAdjointOfDisplacements)
{
  const Set set = hand_made();
  const Dense dense;
  const VecX u = numbers(13, 1, 0.3), lambda = numbers(4, 1, 2.0);
  const System system(set, Bodies().all);
  EXPECT_LT((system.row_displacements(u) - dense.H * u).norm(), 1e-15);
  EXPECT_LT((system.probe_forces(lambda) - dense.H.transpose() * lambda).norm(), 1e-15);
  for (int body : {0, 1}) {
    const MatX& lever = dense.levers[static_cast<std::size_t>(body)];
    const VecX forces = system.body_forces(lambda, body);
    EXPECT_LT((forces - lever.transpose() * lambda).norm(), 1e-15);
  }
}

TEST(System, YieldsTheWorkThatBodiesAndSoftRowsTake)
{
  const Set set = hand_made();
  const Bodies bodies;
  MatX gives = bodies.gives + Dense().coupling;
  gives(1, 1) += 0.3;
  const VecX a = numbers(4, 1, 0.9), b = numbers(4, 1, 0.1);
  const System system(set, bodies.all);
  EXPECT_NEAR(system.yielded(a, b), a.dot(gives * b), 1e-14);
  EXPECT_NEAR(system.yielded(b, a), a.dot(gives * b), 1e-14);
}

// Laws that bend change gaps and couplings; W follows them, the rest stays.
TEST(System, FollowsLawsThatAreLinearisedAnew)
{
  const Bodies bodies;
  System system(hand_made(), bodies.all);
  const MatX C = spd(13, 0.7);
  const MatX before = system.compliance(C);
  EXPECT_FALSE(system.settle(VecX::Zero(4)));  // no law bends
  int calls = 0;
  system.relinearise = [&](const VecX& lambda, Set& set) {
    set.couplings() = {{0, 2, 0.15}, {3, 3, 0.7}};
    set.set_gap(1, lambda[1]);
    return ++calls < 2;
  };
  EXPECT_TRUE(system.settle(Eigen::Vector4d(0, 0.25, 0, 0)));
  MatX change = system.compliance(C) - before;
  EXPECT_NEAR(change(0, 2), 0.1, 1e-13);
  EXPECT_NEAR(change(2, 0), 0.1, 1e-13);
  EXPECT_NEAR(change.norm(), 0.1 * std::sqrt(2.0), 1e-12);
  const VecX g = system.problem(before, VecX::Zero(13)).g;
  EXPECT_NEAR(g[1] + bodies.moved[1], 0.25, 1e-14);
  EXPECT_FALSE(system.settle(VecX::Zero(4)));  // now they are right
}

/// Two rows of coupling points in tets of the body, one of a tip's support, and one whose node z0
/// holds.
Set rows_on(const mesh::Mesh& mesh)
{
  Set set;
  for (int tet : {20, mesh.tet_count() / 2}) {
    const mesh::Tet& nodes = mesh.tets[static_cast<std::size_t>(tet)];
    set.add(tissue_row({nodes.begin(), nodes.end()}, Eigen::Vector4d(0.1, 0.2, 0.3, 0.4),
                       Vec3(1, -2, 0.5), 1e-4));
  }
  VecX weights = VecX::Constant(mesh.node_count(), 1.0 / mesh.node_count());
  std::vector<int> all(static_cast<std::size_t>(mesh.node_count()));
  for (int i = 0; i < mesh.node_count(); ++i) all[static_cast<std::size_t>(i)] = i;
  set.add(tissue_row(all, weights, Vec3::UnitZ(), 0.0));
  set.add(tissue_row({mesh::group_nodes(mesh, "z0").front()}, VecX::Ones(1), Vec3(1, 1, 1), 3e-5));
  return set;
}

// The tissue's own compliance and free motion, whichever ranks own the nodes.
TEST(System, OfATissueIsThatOfItsDenseOperator)
{
  tissue::TissueSettings settings;
  settings.model = tissue::Model::linear;
  settings.boundary.fixed = {{"z0", 7}};
  settings.boundary.gravity = Vec3(0.0, 3.0, -9.81);
  test::Body body({4, 3, 3, Vec3(0.1, 0.08, 0.08), 0.2}, settings);
  const double h = 0.02;
  const tissue::TissueState rest = tissue::at_rest(body.space);
  auto at = body.tissue.linearise(rest, rest.u, {h, h, false});
  const Set set = rows_on(body.mesh);
  const System system(set, {});
  solve::ComplianceReport report;
  const MatX C = at->factor->compliance().block(system.probes(), report);
  const law::Problem problem =
      system.problem(system.compliance(C), at->factor->read(system.probes(), at->forward()));

  MatX A = test::dense_operator(body.mesh, {}, 1.0, 1.0 / (h * h));
  test::fix_dense(A, body.tissue.fixed(), body.mesh.node_count());
  MatX H = MatX::Zero(set.size(), A.rows());
  VecX gap(set.size());
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    const TissueTerm& term = row.tissue.front();
    for (std::size_t a = 0; a < term.anchor.node.size(); ++a)
      H.block<1, 3>(i, 3 * term.anchor.node[a]) +=
          term.anchor.weight[static_cast<Eigen::Index>(a)] * term.direction.transpose();
    gap[i] = row.gap;
  }
  for (int node : mesh::group_nodes(body.mesh, "z0")) H.middleCols<3>(3 * node).setZero();
  const MatX W = H * test::solved(A, H.transpose());
  EXPECT_LT((problem.W - W).norm(), 1e-10 * W.norm());
  EXPECT_EQ(problem.W.row(3).norm(), 0.0);  // held: nothing can move it
  const VecX free = H * body.space.gather(at->alone()).value;
  EXPECT_GT(free.norm(), 1e-4);
  EXPECT_LT((problem.g - gap - free).norm(), 1e-10 * free.norm());
}

}  // namespace
}  // namespace trocar::constraint
