#include <gtest/gtest.h>

#include "law/cone_interior.hpp"
#include "law/cone_newton.hpp"
#include "law/solve.hpp"
#include "support/cones.hpp"

// Friction cones of bodies that touch at many points: problems made from known answers.
namespace trocar::law {
namespace {

using test::Cones;
using Known = test::KnownCones;
using test::known_cones;

TEST(ConeInterior, WithNewtonBehindFindsKnownForces)
{
  for (const Cones kind : {Cones::half_space, Cones::stiff, Cones::rigid, Cones::half_rank})
    for (const double friction : {0.3, 1.0})
      for (const int groups : {10, 50})
        for (unsigned seed = 1; seed <= 3; ++seed) {
          if (kind == Cones::half_rank && friction > 0.3) continue;  // not always
          SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << ' ' << friction << ' '
                                          << groups << ' ' << seed);
          const Known made = known_cones(kind, groups, friction, seed);
          Problem inside = made.problem;
          const Multipliers inner = cone_interior(made.problem, Settings{});
          EXPECT_LT(inner.iterations, 40);
          inside.start = inner.lambda;
          const Multipliers found = cone_newton(inside, Settings{}, 30);
          EXPECT_LE(found.residual, 1e-9);
          EXPECT_TRUE(solve(made.problem, Settings{}).converged);
          if (kind == Cones::half_space) {  // unique
            EXPECT_LT((found.lambda - made.lambda).cwiseAbs().maxCoeff(), 1e-5);
            EXPECT_LT((found.delta - made.delta).cwiseAbs().maxCoeff(), 1e-8);
          }
        }
}

// Intervals, half lines, rows that hold and rows that nothing can move beside the cones.
TEST(ConeInterior, KnowsOtherRows)
{
  const Known cones = known_cones(Cones::half_space, 10, 0.5, 4);
  const Eigen::Index n = cones.problem.rows(), rows = n + 5;
  Problem problem = cones.problem;
  problem.W = 1e-3 * MatX::Identity(rows, rows);
  problem.W.topLeftCorner(n, n) = cones.problem.W;
  for (Eigen::Index k = n; k < n + 4; ++k) problem.W(k, k - 3) = problem.W(k - 3, k) = 2e-4;
  problem.W(n + 4, n + 4) = 0.0;
  VecX lambda = VecX::Zero(rows), delta = VecX::Zero(rows);
  lambda.head(n) = cones.lambda;
  delta.head(n) = cones.delta;
  lambda[n] = 0.7;      // holds
  lambda[n + 1] = 0.2;  // slips on its upper end
  delta[n + 1] = -1e-3;
  lambda[n + 2] = -0.1;  // sticks within [-0.2, 0.2]
  delta[n + 3] = 1e-3;   // a half line that is open
  problem.blocks.push_back({static_cast<int>(n), Law::zero(), 20});
  problem.blocks.push_back({static_cast<int>(n) + 1, Law::box(0.2), 21});
  problem.blocks.push_back({static_cast<int>(n) + 2, Law::box(0.2), 22});
  problem.blocks.push_back({static_cast<int>(n) + 3, Law::half_line(), 23});
  problem.blocks.push_back({static_cast<int>(n) + 4, Law::zero(), 24});
  problem.g = delta - problem.W * lambda;
  problem.start = VecX::Zero(rows);
  ASSERT_TRUE(all_for_cone_interior(problem));
  const Multipliers found = cone_interior(problem, Settings{});
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.lambda - lambda).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(ConeInterior, LeavesLimitedConesToOthers)
{
  Known made = known_cones(Cones::half_space, 3, 0.5, 1);
  EXPECT_TRUE(all_for_cone_interior(made.problem));
  made.problem.blocks[1].law = Law::capped_cone(0.5, 1.0);
  EXPECT_FALSE(all_for_cone_interior(made.problem));
  made.problem.blocks[1].law = Law::disc(1.0);
  EXPECT_FALSE(all_for_cone_interior(made.problem));
}

}  // namespace
}  // namespace trocar::law
