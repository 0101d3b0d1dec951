#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "law/cone_newton.hpp"
#include "law/solve.hpp"

// Friction cones: problems made from known answers.
namespace trocar::law {
namespace {

/// A problem with `groups` cones, whose answer is known: 30 % open, 35 % slip, the rest stick.
struct Known
{
  Problem problem;
  VecX lambda, delta;
};

Known known(int groups, double friction, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto rows = static_cast<Eigen::Index>(3 * groups);
  Known made{{}, VecX::Zero(rows), VecX::Zero(rows)};
  // Points of a half space: compliance falls as one over the distance.
  std::vector<core::Vec3> at;
  for (int k = 0; k < groups; ++k) at.push_back(10.0 * core::Vec3(part(random), part(random), 0.0));
  made.problem.W = MatX::Zero(rows, rows);
  for (int i = 0; i < groups; ++i)
    for (int j = 0; j < groups; ++j) {
      const core::Vec3 apart = at[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(j)];
      const double far = std::sqrt(apart.squaredNorm() + 1.0);
      core::Mat3 block = core::Mat3::Identity() + 0.3 * apart * apart.transpose() / (far * far);
      made.problem.W.block<3, 3>(3 * i, 3 * j) = (i == j ? 1.5e-3 : 1e-3) / far * block;
    }
  for (int k = 0; k < groups; ++k) {
    const double kind = part(random), angle = 2.0 * M_PI * part(random);
    const Eigen::Vector2d e(std::cos(angle), std::sin(angle));
    auto lambda = made.lambda.segment<3>(3 * k);
    auto delta = made.delta.segment<3>(3 * k);
    if (kind < 0.3) {
      delta << 1e-3 * (0.1 + part(random)), 1e-3 * e;
    } else {
      lambda[0] = 0.1 + part(random);
      const bool slips = kind < 0.65;
      lambda.tail<2>() = (slips ? 1.0 : 0.8 * part(random)) * friction * lambda[0] * e;
      if (slips) delta.tail<2>() = -1e-3 * (0.1 + part(random)) * e;
    }
    made.problem.blocks.push_back({3 * k, Law::cone(friction), k});
  }
  made.problem.g = made.delta - made.problem.W * made.lambda;
  return made;
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
