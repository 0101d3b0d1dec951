#include <gtest/gtest.h>

#include "constraint/system.hpp"
#include "core/dense.hpp"
#include "insertion/channel.hpp"
#include "insertion/coupling.hpp"
#include "support/body.hpp"
#include "support/dense.hpp"
#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;
using insertion::Placement;
using test::distorted;

// W is symmetric, positive semidefinite and the dense H A⁻¹ Hᵀ.
TEST(ConstraintProblem, WIsTheDenseProduct)
{
  step::Scene scenario = test::needle_scenario(distorted);
  scenario.needles[0].model = needle::Model::beam;
  tissue::TissueSettings settings = scenario.tissue;
  test::Body body(distorted, settings);
  const mesh::Locator locator(body.mesh);
  insertion::InsertionSettings coupling = scenario.insertion;
  coupling.placement.merge = 0.0;
  const insertion::Ground ground(body.mesh, locator, coupling, {{2000.0, 0.4}});
  scenario.needles[0].motion.inserted = 0.04;
  const needle::Needle needle(scenario.needles[0]);
  insertion::InsertionState state = insertion::start(ground, needle);
  const fem::GlobalField u{core::VecX::Zero(3 * body.mesh.node_count())};
  constraint::Set set;
  const insertion::Deformed tissue(body.mesh, locator, u);
  insertion::add_rows(ground, state, {needle.initial().shaft, tissue, 0, 0.02}, set);
  const double h = 0.02;
  const core::TimeStep now{h, h, false};
  const tissue::TissueState rest = tissue::at_rest(body.space);
  auto at = body.tissue.linearise(rest, rest.u, now);
  const auto linear = needle.linearise(needle.initial(), needle.initial(), now);
  const constraint::System system(set, {{linear.held, linear.factor, linear.free_increment}});
  solve::ComplianceReport report;
  const core::MatX C = at->factor->compliance().block(system.probes(), report);
  const law::Problem problem =
      system.problem(system.compliance(C), at->factor->read(system.probes(), at->forward()));

  const auto& material = settings.materials[0];
  core::MatX A = test::dense_operator(body.mesh, material, 1.0 + material.rayleigh_stiffness / h,
                                      1.0 / (h * h));
  test::fix_dense(A, body.tissue.fixed(), body.mesh.node_count());
  core::MatX H = core::MatX::Zero(set.size(), A.rows());
  core::MatX H_n = core::MatX::Zero(set.size(), needle.dofs());
  for (int i = 0; i < set.size(); ++i) {
    const auto& row = set.rows()[static_cast<std::size_t>(i)];
    const constraint::TissueTerm& term = row.tissue.front();
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k)
        if (!body.tissue.fixed().fixed(term.anchor.node[static_cast<std::size_t>(a)], k))
          H(i, 3 * term.anchor.node[static_cast<std::size_t>(a)] + k) +=
              term.anchor.weight[a] * term.direction[k];
    for (const auto& [dof, value] : row.on_body) H_n(i, dof) += value;
  }
  const Eigen::Index free = needle.dofs() - 6;
  const core::MatX A_n = linear.A.bottomRightCorner(free, free);
  const core::MatX dense = H * test::solved(A, H.transpose()) +
                           H_n.rightCols(free) * test::solved(A_n, H_n.rightCols(free).transpose());
  const core::MatX& W = problem.W;
  EXPECT_LT((W - dense).norm(), 1e-10 * dense.norm());
  EXPECT_EQ((W - W.transpose()).norm(), 0.0);
  EXPECT_GE(core::symmetric_eigenvalues(W)[0], -1e-12 * W.norm());
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
    const insertion::Ground ground(mesh, locator,
                                   {{Placement::spacing, spacing, 0.3}, test::same({}), 0.0, 1e-9},
                                   {{2000.0, 0.4}});
    needle::NeedleSettings settings;
    settings.section = {0.0005, 0.0, 2e11, 0.3};
    settings.motion.entry = Vec3(0, 0.0093, 0.0107);
    settings.motion.length = 0.2;
    settings.motion.inserted = 0.15;
    const needle::Needle needle(settings);
    insertion::InsertionState state = insertion::start(ground, needle);
    const fem::GlobalField u{core::VecX::Zero(3 * mesh.node_count())};
    constraint::Set set;
    const insertion::Deformed tissue(mesh, locator, u);
    insertion::add_rows(ground, state, {needle.initial().shaft, tissue, 0, 0.02}, set);
    EXPECT_EQ(set.size(), rows);
  }
}

}  // namespace
}  // namespace trocar
