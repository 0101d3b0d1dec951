#include <gtest/gtest.h>

#include <cmath>

#include "law/box_qp.hpp"
#include "law/schur_complement.hpp"
#include "law/solve.hpp"
#include "support/problem.hpp"

// Laws of two and three rows: discs, and Coulomb's cone.
namespace trocar::law {
namespace {

constexpr Method methods[] = {Method::automatic, Method::interior_point, Method::active_set,
                              Method::pgs, Method::hybrid};

/// Points with a bilateral row and a disc each, whose radii go over three decades.
Problem with_discs(int points, int rank, unsigned seed)
{
  Problem problem = test::random_problem(points, rank, seed);
  problem.blocks.clear();
  for (int point = 0; point < points; ++point) {
    const double radius = std::pow(10.0, 1.0 - (static_cast<int>(seed) + point) % 4);
    problem.blocks.push_back({3 * point, Law::zero(), point});
    problem.blocks.push_back({3 * point + 1, Law::disc(radius), point});
  }
  return problem;
}

TEST(Discs, AreSolvedAlikeByAllMethods)
{
  int slipping = 0, sticking = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = with_discs(6, 40, seed);
    VecX reference;
    for (Method method : methods) {
      const Multipliers answer =
          solve(problem, {.method = method, .tolerance = 1e-11, .max_iterations = 100000});
      ASSERT_TRUE(answer.converged) << answer.why << static_cast<int>(method);
      EXPECT_LE(answer.residual, 1e-11);
      if (reference.size() == 0) reference = answer.lambda;
      EXPECT_LT((answer.lambda - reference).norm(), 1e-4 * reference.norm());
    }
    for (const Block& block : problem.blocks)
      if (block.law.set == Law::Set::disc)
        (reference.segment<2>(block.first).norm() < block.law.upper * (1 - 1e-9) ? sticking
                                                                                 : slipping) += 1;
  }
  EXPECT_GE(slipping, 15);
  EXPECT_GE(sticking, 15);
}

TEST(Discs, OfSingularProblemsHaveUniqueGaps)
{
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem problem = with_discs(10, 18, seed);
    const Multipliers one = solve(problem, {.tolerance = 1e-10});
    const Multipliers two = solve(problem, {.method = Method::interior_point, .tolerance = 1e-10});
    ASSERT_TRUE(one.converged) << one.why << " seed " << seed;
    ASSERT_TRUE(two.converged) << two.why << " seed " << seed;
    EXPECT_TRUE(one.nonunique);
    EXPECT_LT((one.delta - two.delta).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// One pair on which a barrier for its circle jams: with the second-order cone it does not.
TEST(Discs, ABorderIsReachedFromWithin)
{
  MatX S(2, 2);
  S << .0015499098, .000484558, .000484558, .0025065061;
  const VecX s = (VecX(2) << .00059331801, .00200665009).finished();
  const Bounds bounds{VecX::Constant(2, 0.5), {0}};
  const BoxSolution answer = interior_point({S, s, bounds}, VecX::Zero(2), 1e-9, 100);
  EXPECT_TRUE(answer.finished);
  EXPECT_LE(answer.factorisations, 15);
  EXPECT_LT(box_residual({S, s, bounds}, answer.x), 1e-9);
}

TEST(Discs, InteriorPointsNeedNoRegularityNorOneSizeOfDiscs)
{
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Problem problem = with_discs(8, seed % 2 == 0 ? 60 : 16, seed);
    SchurComplement condensed(problem);
    const BoxSolution answer = interior_point(condensed.qp(), condensed.start(), 1e-9, 100);
    EXPECT_TRUE(answer.finished) << seed;
    EXPECT_LE(answer.factorisations, 40) << seed;
  }
}

TEST(Discs, OfALastStepNeedFewFactorisations)
{
  const Problem problem = with_discs(30, 120, 11);
  SchurComplement condensed(problem);
  const BoxSolution cold = interior_point(condensed.qp(), condensed.start(), 1e-9, 100);
  ASSERT_TRUE(cold.finished);
  EXPECT_LE(cold.factorisations, 25);
  const BoxSolution warm = pair_newton(condensed.qp(), 0.99 * cold.x, 1e-12, 12);
  EXPECT_TRUE(warm.finished);
  EXPECT_LE(warm.factorisations, 5);
  EXPECT_LT((warm.x - cold.x).norm(), 1e-6 * cold.x.norm());
}

/// One contact (normal row and two tangential ones) on compliance W.
Problem contact(const MatX& W, const VecX& g, const Law& cone)
{
  Problem problem;
  problem.W = W;
  problem.g = g;
  problem.start = VecX::Zero(g.size());
  problem.blocks = {{0, cone, 0}};
  return problem;
}

MatX coupled()
{
  MatX W(3, 3);
  W << 1.0, 0.2, -0.1, 0.2, 1.5, 0.3, -0.1, 0.3, 1.2;
  return 1e-3 * W;
}

TEST(Cone, SlidesAgainstItsSlipAndIsNotLifted)
{
  for (Method method : methods)
    for (const Eigen::Vector2d& t : {Eigen::Vector2d(5e-3, 2e-3), {-4e-3, 4e-3}, {0.0, -6e-3}}) {
      const VecX g = (VecX(3) << -1e-3, t).finished();
      const Multipliers m = solve(contact(coupled(), g, Law::cone(0.4)),
                                  {.method = method, .tolerance = 1e-12, .max_iterations = 100000});
      ASSERT_TRUE(m.converged) << m.why;
      EXPECT_NEAR(m.delta[0], 0.0, 1e-11);
      const Eigen::Vector2d force = m.lambda.tail<2>(), slip = m.delta.tail<2>();
      EXPECT_NEAR(force.norm(), 0.4 * m.lambda[0], 1e-8);
      EXPECT_NEAR(force.dot(slip), -force.norm() * slip.norm(), 1e-8 * force.norm() * slip.norm());
      EXPECT_LT(m.residual, 1e-11);
    }
}

// Where it sticks the three rows hold: λ = -W⁻¹ g. Where the gap opens nothing is borne.
TEST(Cone, SticksAndOpens)
{
  VecX g = (VecX(3) << -5e-3, 1e-4, -2e-4).finished();
  const Multipliers stuck = solve(contact(coupled(), g, Law::cone(0.4)), {});
  ASSERT_TRUE(stuck.converged) << stuck.why;
  EXPECT_LT((stuck.lambda + coupled().ldlt().solve(g)).norm(), 1e-6);
  g[0] = 1e-3;
  const Multipliers open = solve(contact(coupled(), g, Law::cone(0.4)), {});
  ASSERT_TRUE(open.converged) << open.why;
  EXPECT_EQ(open.lambda.norm(), 0.0);
}

// Tangents may be turned in their plane: the forces turn with them.
TEST(Cone, HasNoPreferredDirection)
{
  const VecX g = (VecX(3) << -1e-3, 4e-3, 3e-3).finished();
  const Settings exact{.method = Method::automatic, .tolerance = 1e-13};
  const VecX first = solve(contact(coupled(), g, Law::cone(0.4)), exact).lambda;
  core::Mat3 Q = core::Mat3::Identity();
  Q.bottomRightCorner<2, 2>() = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  const VecX turned =
      solve(contact(Q * coupled() * Q.transpose(), Q * g, Law::cone(0.4)), exact).lambda;
  EXPECT_LT((turned - Q * first).norm(), 1e-8);
}

TEST(Cone, StopsAtItsCapAndYieldsAtItsLimit)
{
  const VecX g = (VecX(3) << -5e-3, 9e-3, 0.0).finished();
  const Multipliers capped = solve(contact(coupled(), g, Law::capped_cone(0.4, 0.7)), {});
  ASSERT_TRUE(capped.converged) << capped.why;
  EXPECT_NEAR(capped.lambda.tail<2>().norm(), 0.7, 1e-9);
  EXPECT_NEAR(capped.delta[0], 0.0, 1e-9);
  const Multipliers limited = solve(contact(coupled(), g, Law::cone(0.4, 2.0)), {});
  ASSERT_TRUE(limited.converged) << limited.why;
  EXPECT_NEAR(limited.lambda[0], 2.0, 1e-9);
  EXPECT_LT(limited.delta[0], -1e-3);
  EXPECT_NEAR(limited.lambda.tail<2>().norm(), 0.8, 1e-6);
}

// On a place that is held all over a cone bears what Coulomb says of its gap.
TEST(Cone, OfAHeldPlaceBearsItsEnds)
{
  const VecX g = (VecX(3) << -1e-3, 3e-3, 4e-3).finished();
  const Multipliers m = solve(contact(MatX::Zero(3, 3), g, Law::cone(0.5, 2.0)), {});
  ASSERT_TRUE(m.converged) << m.why;
  EXPECT_LT((m.lambda - (VecX(3) << 2.0, -0.6, -0.8).finished()).norm(), 1e-12);
}

// A cone without limit beside a small force, and sizes that are met to the tolerance only: it is
// converged when its own residual says so, and slips where it slips.
TEST(Cone, IsJudgedByItsOwnResidual)
{
  MatX weak(3, 3);
  weak << 1.0, 5e-4, 0.0, 5e-4, 1e-6, 0.0, 0.0, 0.0, 1e-6;
  const Problem one =
      contact(1e-2 * weak, (VecX(3) << -1e-2, 1e-4, 0.0).finished(), Law::cone(0.3));
  const Multipliers m = solve(one, {});
  ASSERT_TRUE(m.converged) << m.why;
  EXPECT_LE(m.residual, 1e-9);
  EXPECT_LE(kkt_residual(one, m.lambda), 1e-9);

  const Problem other =
      contact(coupled(), (VecX(3) << -3.639e-4, -9.526e-4, -4.8827e-3).finished(), Law::cone(0.4));
  const Multipliers slips = solve(other, {});
  ASSERT_TRUE(slips.converged) << slips.why;
  EXPECT_GT(slips.delta.tail<2>().norm(), 1e-3);
  EXPECT_FALSE(same_states(other, slips.lambda, slips.lambda, 1e-9));
  EXPECT_EQ(response(other, slips.lambda, VecX::Ones(3), 1e-9).tail<2>().norm(), 0.0);
}

// Between two answers of the same state the problem is linear, unless a slip may turn.
TEST(Cone, KnowsWhenItsStatesAreTheSame)
{
  Problem one = contact(coupled(), VecX::Zero(3), Law::cone(0.5));
  const auto few = [](double n, double t) { return (VecX(3) << n, t, 0.0).finished(); };
  EXPECT_TRUE(same_states(one, few(1.0, 0.1), few(2.0, 0.3), 1e-12));   // holds
  EXPECT_TRUE(same_states(one, few(0.0, 0.0), few(0.0, 0.0), 1e-12));   // apart
  EXPECT_FALSE(same_states(one, few(1.0, 0.5), few(2.0, 1.0), 1e-12));  // slips
  EXPECT_FALSE(same_states(one, few(1.0, 0.5), few(2.0, 0.3), 1e-12));  // held again
  EXPECT_FALSE(same_states(one, few(0.0, 0.0), few(2.0, 0.3), 1e-12));  // touches
}

}  // namespace
}  // namespace trocar::law
