#include <gtest/gtest.h>

#include <cmath>

#include "law/cone_newton.hpp"
#include "law/solve.hpp"
#include "support/cones.hpp"

// Friction cones: problems made from known answers.
namespace trocar::law {
namespace {

using test::Cones;
using Known = test::KnownCones;

Known known(int groups, double friction, unsigned seed)
{
  return test::known_cones(Cones::half_space, groups, friction, seed);
}

TEST(ConeNewton, FindsAKnownAnswer)
{
  for (const double friction : {0.3, 1.0})
    for (const int groups : {5, 20, 50})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(testing::Message() << friction << " " << groups << " " << seed);
        const Known made = known(groups, friction, seed);
        const Multipliers found = cone_newton(made.problem, Settings{}, 30);
        ASSERT_TRUE(found.converged);
        EXPECT_LT(found.residual, 1e-9);
        EXPECT_LT((found.lambda - made.lambda).cwiseAbs().maxCoeff(), 1e-5);
        EXPECT_LT((found.delta - made.delta).cwiseAbs().maxCoeff(), 1e-8);
        EXPECT_EQ(found.rank, 3 * groups);
        EXPECT_TRUE(solve(made.problem, Settings{}).converged);
      }
}

// With a limit of the shear force, and rows of other laws beside the cones.
TEST(ConeNewton, KnowsCapsAndOtherRows)
{
  Known made = known(10, 0.5, 3);
  for (Block& block : made.problem.blocks) block.law = Law::capped_cone(0.5, 0.2);
  const Eigen::Index rows = made.problem.rows() + 2;
  Problem more = made.problem;
  more.W = 1e-3 * MatX::Identity(rows, rows);
  more.W.topLeftCorner(rows - 2, rows - 2) = made.problem.W;
  more.W.block(0, rows - 2, rows - 2, 2).setConstant(1e-5);
  more.W.block(rows - 2, 0, 2, rows - 2).setConstant(1e-5);
  more.g.conservativeResize(rows);
  more.g.tail<2>() << 1e-3, -2e-3;
  more.blocks.push_back({static_cast<int>(rows) - 2, Law::zero(), 10});
  more.blocks.push_back({static_cast<int>(rows) - 1, Law::box(0.5), 11});
  const Multipliers found = cone_newton(more, Settings{}, 30);
  ASSERT_TRUE(found.converged);
  EXPECT_LT(kkt_residual(more, found.lambda), 1e-9);
  EXPECT_NEAR(found.delta[rows - 2], 0.0, 1e-9);
  EXPECT_NEAR(found.lambda[rows - 1], 0.5, 1e-9);
  double largest = 0.0;
  for (int k = 0; k < 10; ++k)
    largest = std::max(largest, found.lambda.segment<2>(3 * k + 1).norm());
  EXPECT_NEAR(largest, 0.2, 1e-6);
}

TEST(ConeNewton, RefusesWhatItDoesNotKnow)
{
  EXPECT_TRUE(all_for_cone_newton(known(4, 0.5, 1).problem));
  Problem discs;
  discs.blocks = {{0, Law::disc(1.0), 0}};
  EXPECT_FALSE(all_for_cone_newton(discs));
  discs.blocks = {{0, Law::zero(), 0}};
  EXPECT_FALSE(all_for_cone_newton(discs));
}

}  // namespace
}  // namespace trocar::law
