#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "law/solve.hpp"

namespace trocar::law {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Problem rows(const MatX& W, const VecX& g, const std::vector<Law>& laws)
{
  Problem problem;
  problem.W = W;
  problem.g = g;
  problem.start = VecX::Zero(g.size());
  int first = 0;
  for (const Law& law : laws) {
    problem.blocks.push_back({first, law, first});
    first = problem.blocks.back().end();
  }
  return problem;
}

// One row: apart, in contact, yielding, with every method.
TEST(Push, HasThreeStates)
{
  const MatX W = MatX::Constant(1, 1, 2e-3);
  for (Method method :
       {Method::automatic, Method::pgs, Method::hybrid, Method::active_set, Method::interior_point})
    for (const auto& [gap, force] : {std::pair{1e-3, 0.0}, {-1e-3, 0.5}, {-5e-3, 1.0}}) {
      Settings settings;
      settings.method = method;
      const Multipliers m =
          solve(rows(W, VecX::Constant(1, gap), {Law::interval(0.0, 1.0)}), settings);
      ASSERT_TRUE(m.converged) << m.why;
      EXPECT_NEAR(m.lambda[0], force, 1e-6);
      EXPECT_NEAR(m.delta[0], gap + 2e-3 * force, 1e-8);
    }
}

// Limits from 1e-12 to infinity beside an ordinary row: each as if it were written out.
TEST(Push, TakesAnyLimit)
{
  MatX W(2, 2);
  W << 2e-3, 0.5e-3, 0.5e-3, 1e-3;
  const VecX g = (VecX(2) << -1e-3, -2e-3).finished();
  for (double limit : {0.0, 1e-12, 0.05, 1e3, 1e12, 1e300, infinity}) {
    const Problem problem = rows(W, g, {Law::interval(0.0, limit), Law::box(limit)});
    const Multipliers m = solve(problem, {});
    ASSERT_TRUE(m.converged) << m.why;
    // Both stick: W λ = -g gives λ = (0, 2).
    const VecX stick = -W.ldlt().solve(g);
    if (limit > 3.0) {
      EXPECT_LT((m.lambda - stick).norm(), 1e-9) << limit;
    }
    EXPECT_GE(m.lambda[0], -1e-12);
    EXPECT_LE(m.lambda.cwiseAbs().maxCoeff(), limit);
  }
}

/// Normal row and lateral row with Coulomb's bound, coupled by `coupling`.
Problem contact(double coupling, double friction)
{
  MatX W(2, 2);
  W << 1e-3, coupling, coupling, 1e-3;
  return rows(W, (VecX(2) << -1e-3, -5e-3).finished(),
              {Law::half_line(), Law::follower(0, friction)});
}

// Sliding: λ_t = μ λ_n and W_nn λ_n + W_nt λ_t = -g_n, so λ_n = 1 N / (1 + μ W_nt / W_nn).
TEST(FollowingBounds, SettleAtCoulombsLaw)
{
  for (double coupling : {-0.4e-3, 0.0, 0.4e-3})
    for (double friction : {0.0, 0.3, 1.0}) {
      const Multipliers m = solve(contact(coupling, friction), {});
      ASSERT_TRUE(m.converged) << m.why;
      const double normal = 1.0 / (1.0 + friction * coupling / 1e-3);
      EXPECT_NEAR(m.lambda[0], normal, 2e-6);
      EXPECT_NEAR(m.lambda[1], friction * normal, 2e-6);
      // The ratio of successive changes is μ |W_nt| / W_nn.
      if (friction * coupling != 0.0) {
        EXPECT_NEAR(m.contraction, std::abs(friction * coupling) / 1e-3, 1e-3);
      }
    }
}

// Bounds that overshoot in turn go half the way: λ_n = 1 / (1 + 1.5 · 0.9).
TEST(FollowingBounds, SettleWhereTheyOvershoot)
{
  const Multipliers m = solve(contact(0.9e-3, 1.5), {});
  ASSERT_TRUE(m.converged) << m.why;
  EXPECT_NEAR(m.lambda[0], 1.0 / 2.35, 2e-6);
  EXPECT_GT(m.outer, 5);
}

// A follower on a held place does not keep another one from going half the way.
TEST(FollowingBounds, SettleBesideOneThatNothingMoves)
{
  MatX W = MatX::Zero(3, 3);
  W.topLeftCorner(2, 2) << 1e-3, 0.9e-3, 0.9e-3, 1e-3;
  const Problem problem = rows(W, (VecX(3) << -1e-3, -5e-3, 0.0).finished(),
                               {Law::half_line(), Law::follower(0, 1.5), Law::follower(0, 0.5)});
  const Multipliers m = solve(problem, {});
  ASSERT_TRUE(m.converged) << m.why;
  EXPECT_NEAR(m.lambda[0], 1.0 / 2.35, 2e-6);
  EXPECT_TRUE(std::isfinite(m.contraction));
}

// What cannot be borne is no solution: a gap against a set without an end.
TEST(Push, AGapOfAHeldPlaceWithoutLimitIsAResidual)
{
  const Problem problem = rows(MatX::Zero(1, 1), VecX::Constant(1, -1e-3), {Law::half_line()});
  EXPECT_DOUBLE_EQ(kkt_residual(problem, VecX::Zero(1)), 1e-3);
}

// Beyond what that mends they are refused, with the ratio.
TEST(FollowingBounds, ThatDoNotSettleAreRefused)
{
  const Multipliers m = solve(contact(0.9e-3, 5.0), {});
  EXPECT_FALSE(m.converged);
  EXPECT_NE(m.why.find("did not settle"), std::string::npos) << m.why;
}

}  // namespace
}  // namespace trocar::law
