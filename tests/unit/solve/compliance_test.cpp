#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/dense.hpp"
#include "solve/isolated_compliance.hpp"
#include "support/body.hpp"
#include "support/dense.hpp"

namespace trocar {
namespace {

tissue::TissueSettings held(solve::Provider provider)
{
  tissue::TissueSettings settings;
  settings.model = tissue::Model::linear;
  settings.boundary.fixed = {{"z0", 7}, {"x0", 2}};
  settings.provider = provider;
  return settings;
}

/// Dense inverse of the operator of step h, zero on fixed dofs.
core::MatX dense_inverse(const test::Body& body, double h)
{
  core::MatX A = test::dense_operator(body.mesh, {}, 1.0, 1.0 / (h * h));
  test::fix_dense(A, body.tissue.fixed(), body.mesh.node_count());
  core::MatX inverse = test::inverse(A);
  for (int node = 0; node < body.mesh.node_count(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (body.tissue.fixed().fixed(node, axis)) {
        inverse.row(3 * node + axis).setZero();
        inverse.col(3 * node + axis).setZero();
      }
  return inverse;
}

core::MatX selection(const test::Body& body, const solve::Probes& probes)
{
  core::MatX S = core::MatX::Zero(probes.size(), 3 * body.mesh.node_count());
  int row = 0;
  for (int node : probes.nodes)
    for (int axis = 0; axis < 3; ++axis) S(row++, 3 * node + axis) = 1.0;
  for (const auto* wide : probes.wide)
    S.row(row++) = body.space.gather(wide->vector).value.transpose();
  return S;
}

solve::DistributedFunctional wide_probe(const test::Body& body, long long id)
{
  fem::GlobalField field{core::VecX(3 * body.mesh.node_count())};
  for (Eigen::Index i = 0; i < field.value.size(); ++i)
    field.value[i] = std::sin(static_cast<double>(i * id));
  return {id, body.space.restrict_to_owned(field)};
}

class Compliance : public ::testing::TestWithParam<solve::Provider>
{
};

TEST_P(Compliance, EqualsTheDenseInverseWhateverWasAskedBefore)
{
  test::Body body({4, 3, 3, core::Vec3(0.1, 0.08, 0.08), 0.2}, held(GetParam()));
  const double h = 0.01;
  body.tissue.prepare({0.0, h, false});
  const core::MatX inverse = dense_inverse(body, h);
  const solve::DistributedFunctional one = wide_probe(body, 1), two = wide_probe(body, 2);
  const auto& tet = body.mesh.tets[20];
  std::vector<int> whole_tet(tet.begin(), tet.end());
  std::sort(whole_tet.begin(), whole_tet.end());
  const std::vector<solve::Probes> requests{
      {{5, 17, 40}, {}},             // first
      {{5, 17, 40}, {}},             // all reused
      {{17, 41, 60}, {&one}},        // some dropped, some new, a wide one
      {whole_tet, {&one, &two}},     // all dofs of a tet
      {{0, 5, 17, 40, 79}, {&two}},  // a node that is fixed altogether
      {{}, {&one}}};
  for (const auto& probes : requests) {
    solve::ComplianceReport report;
    const core::MatX C = body.tissue.factor().compliance().block(probes, report);
    const core::MatX S = selection(body, probes);
    const core::MatX reference = S * inverse * S.transpose();
    EXPECT_LT((C - reference).norm(), 1e-10 * reference.norm());
    EXPECT_EQ((C - C.transpose()).norm(), 0.0);
    EXPECT_GE(core::symmetric_eigenvalues(C)[0], -1e-12 * C.norm());
    EXPECT_EQ(report.probes, probes.size());
  }
  // Nodes 5 17 40 41 60, the tet's, 79, and two wide vectors: each column once.
  EXPECT_EQ(body.ledger.factorisations, 1);
  const auto built = body.ledger.columns_built;
  solve::ComplianceReport again;
  body.tissue.factor().compliance().block(requests[4], again);
  EXPECT_EQ(again.built, 0);
  EXPECT_EQ(body.ledger.columns_built, built);
}

TEST_P(Compliance, ANewOperatorForgetsEveryColumn)
{
  auto settings = held(GetParam());
  settings.model = tissue::Model::corotational;
  test::Body body({3, 3, 3, core::Vec3(0.1, 0.1, 0.1)}, settings);
  const tissue::TissueState rest = tissue::at_rest(body.space);
  body.tissue.linearise(rest, rest.u, {0.01, 0.01, false});
  solve::ComplianceReport report;
  body.tissue.factor().compliance().block({{62, 63}, {}}, report);
  EXPECT_EQ(report.built, 6);
  // Same rotations: same version, nothing is assembled or solved again.
  body.tissue.linearise(rest, rest.u, {0.02, 0.01, false});
  body.tissue.factor().compliance().block({{62, 63}, {}}, report);
  EXPECT_EQ(report.built, 0);
  EXPECT_EQ(report.reused, 6);
  EXPECT_EQ(body.ledger.assemblies, 1);
  fem::OwnedField turned = rest.u;
  for (int i = 0; i < body.space.owned(); ++i) {
    const core::Vec3& X = body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))];
    turned.node(i) = core::rotation_exp(core::Vec3(0, 0.1 * X.z() / 0.1, 0)) * X - X;
  }
  body.tissue.linearise(rest, turned, {0.02, 0.01, false});
  body.tissue.factor().compliance().block({{62, 63}, {}}, report);
  EXPECT_EQ(report.built, 6);
  EXPECT_EQ(body.ledger.assemblies, 2);
}

// What a step does with one operator: the free motion at the probes, and the motion with forces on
// them, for probes that come and go one node at a time.
TEST_P(Compliance, FinishesAHalfSolutionWithForcesOnItsProbes)
{
  test::Body body({4, 3, 3, core::Vec3(0.1, 0.08, 0.08), 0.2}, held(GetParam()));
  body.tissue.prepare({0.0, 0.01, false});
  const tissue::TissueState rest = tissue::at_rest(body.space);
  const core::MatX inverse = dense_inverse(body, 0.01);
  const solve::DistributedFunctional wide = wide_probe(body, 3);
  const fem::GlobalField load{core::VecX::NullaryExpr(
      3 * body.mesh.node_count(), [](Eigen::Index i) { return std::cos(static_cast<double>(i)); })};
  fem::OwnedField b = body.space.restrict_to_owned(load);
  body.tissue.fixed().clear(b);
  const core::VecX dense_load = body.space.gather(b).value;
  std::vector<int> nodes{20};
  for (int added : {33, 21, 60, 5, 41, 22}) {
    nodes.insert(std::lower_bound(nodes.begin(), nodes.end(), added), added);
    if (nodes.size() > 4) nodes.erase(nodes.begin());
    const solve::Probes probes{nodes, {&wide}};
    const core::MatX S = selection(body, probes);
    const core::VecX f = core::VecX::LinSpaced(probes.size(), -1.0, 2.0);
    auto at = body.tissue.linearise(rest, rest.u, {0.01, 0.01, false});
    const solve::HalfSolution half = at->factor->begin(b);
    const core::VecX free = inverse * dense_load;
    const core::VecX read = at->factor->read(probes, half);
    EXPECT_LT((read - S * free).norm(), 1e-10 * free.norm() * S.norm());
    const core::VecX exact = free + inverse * (S.transpose() * f);
    const core::VecX u = body.space.gather(at->factor->finish(half, probes, f)).value;
    EXPECT_LT((u - exact).norm(), 1e-10 * exact.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Providers, Compliance,
                         ::testing::Values(solve::Provider::supernodal, solve::Provider::ksp,
                                           solve::Provider::ksp_block));

// Nodes put last in the factor give the same columns; those outside the tube too, in any order.
TEST(Supernodal, PinnedNodesHaveTheSameColumns)
{
  const test::BlockShape shape{4, 3, 3, core::Vec3(0.1, 0.08, 0.08), 0.2};
  tissue::TissueSettings settings = held(solve::Provider::supernodal);
  test::Body plain(shape, settings);
  settings.ordered_last = {26, 27, 31, 32, 33, 37, 52, 53};
  test::Body ordered_last(shape, settings);
  for (test::Body* body : {&plain, &ordered_last}) body->tissue.prepare({0.0, 0.01, false});
  for (const std::vector<int>& nodes :
       {std::vector<int>{27, 31, 52}, {5, 31, 60}, {5, 17, 26, 27, 31, 60}}) {
    solve::ComplianceReport report;
    const core::MatX a = plain.tissue.factor().compliance().block({nodes, {}}, report);
    const core::MatX b = ordered_last.tissue.factor().compliance().block({nodes, {}}, report);
    EXPECT_LT((a - b).norm(), 1e-11 * a.norm());
  }
}

TEST(Reuse, CanBeTurnedOff)
{
  for (solve::Provider provider : {solve::Provider::supernodal, solve::Provider::ksp_block}) {
    tissue::TissueSettings settings = held(provider);
    settings.reuse = solve::Reuse::none;
    test::Body body({3, 3, 3, core::Vec3(0.1, 0.1, 0.1)}, settings);
    const tissue::TissueState rest = tissue::at_rest(body.space);
    solve::ComplianceReport report;
    for (int n = 1; n <= 3; ++n) {
      auto at = body.tissue.linearise(rest, rest.u, {0.01 * n, 0.01, false});
      at->forward();  // with which a step begins
      at->factor->compliance().block({{62, 63}, {}}, report);
      EXPECT_EQ(report.built, 6);
      EXPECT_EQ(report.reused, 0);
    }
    EXPECT_EQ(body.ledger.factorisations, 1);
  }
}

TEST(LinearTissue, OneOperatorPerDistinctStepLength)
{
  test::Body body({2, 2, 2, core::Vec3(0.1, 0.1, 0.1)}, held(solve::Provider::automatic));
  const tissue::TissueState rest = tissue::at_rest(body.space);
  for (double h : {0.01, 0.005, 0.01, 0.005, 0.01})
    body.tissue.linearise(rest, rest.u, {h, h, false});
  EXPECT_EQ(body.ledger.assemblies, 2);
  EXPECT_EQ(body.ledger.factorisations, 2);
}

}  // namespace
}  // namespace trocar
