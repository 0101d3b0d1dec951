#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "law/cone_interior.hpp"
#include "law/cone_newton.hpp"
#include "law/solve.hpp"

// Friction cones of bodies that touch at many points: problems made from known answers.
namespace trocar::law {
namespace {

enum class Kind { half_space, stiff, rigid, half_rank };

MatX random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  MatX A(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j) A(i, j) = normal(random);
  return A;
}

/// Compliance of points on a half space; of a rigid body (rank 6), alone or with a part of 1e-3 of
/// a half space's; or of half the rank. Diagonal about 1e-3 m/N.
MatX compliance(Kind kind, const std::vector<core::Vec3>& at, std::mt19937& random)
{
  const auto rows = static_cast<Eigen::Index>(3 * at.size());
  if (kind == Kind::half_rank) {
    const MatX A = random_matrix(rows, rows / 2, random);
    return 1e-3 / static_cast<double>(rows / 2) * (A * A.transpose());
  }
  MatX W = MatX::Zero(rows, rows);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < at.size(); ++j) {
      const core::Vec3 apart = at[i] - at[j];
      const double far = std::sqrt(apart.squaredNorm() + 1.0);
      const core::Mat3 block =
          core::Mat3::Identity() + 0.3 * apart * apart.transpose() / (far * far);
      W.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          (i == j ? 1.5e-3 : 1e-3) / far * block;
    }
  if (kind == Kind::half_space) return W;
  MatX H(rows, 6);  // motions of a rigid body
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(3 * i) + axis;
      H.row(row) << core::Vec3::Unit(axis).transpose(),
          (0.2 * at[i]).cross(core::Vec3::Unit(axis)).transpose();
    }
  return 1e-3 * H * H.transpose() + (kind == Kind::stiff ? 1e-3 : 0.0) * W;
}

struct Known
{
  Problem problem;
  VecX lambda, delta;
};

/// 30 % of the groups are open, 35 % slip, the rest sticks.
Known known(Kind kind, int groups, double friction, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto rows = static_cast<Eigen::Index>(3 * groups);
  Known made{{}, VecX::Zero(rows), VecX::Zero(rows)};
  std::vector<core::Vec3> at;
  for (int k = 0; k < groups; ++k) at.push_back(10.0 * core::Vec3(part(random), part(random), 0.0));
  made.problem.W = compliance(kind, at, random);
  for (int k = 0; k < groups; ++k) {
    const double what = part(random), angle = 2.0 * M_PI * part(random);
    const Eigen::Vector2d e(std::cos(angle), std::sin(angle));
    auto lambda = made.lambda.segment<3>(3 * k);
    auto delta = made.delta.segment<3>(3 * k);
    if (what < 0.3) {
      delta << 1e-3 * (0.1 + part(random)), 1e-3 * e;
    } else {
      lambda[0] = 0.1 + part(random);
      const bool slips = what < 0.65;
      lambda.tail<2>() = (slips ? 1.0 : 0.8 * part(random)) * friction * lambda[0] * e;
      if (slips) delta.tail<2>() = -1e-3 * (0.1 + part(random)) * e;
    }
    made.problem.blocks.push_back({3 * k, Law::cone(friction), k});
  }
  made.problem.g = made.delta - made.problem.W * made.lambda;
  made.problem.start = VecX::Zero(rows);
  return made;
}

TEST(ConeInterior, WithNewtonBehindFindsKnownForces)
{
  for (const Kind kind : {Kind::half_space, Kind::stiff, Kind::rigid, Kind::half_rank})
    for (const double friction : {0.3, 1.0})
      for (const int groups : {10, 50})
        for (unsigned seed = 1; seed <= 3; ++seed) {
          if (kind == Kind::half_rank && friction > 0.3) continue;  // not always
          SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << ' ' << friction << ' '
                                          << groups << ' ' << seed);
          const Known made = known(kind, groups, friction, seed);
          Problem inside = made.problem;
          const Multipliers inner = cone_interior(made.problem, Settings{});
          EXPECT_LT(inner.iterations, 40);
          inside.start = inner.lambda;
          const Multipliers found = cone_newton(inside, Settings{}, 30);
          EXPECT_LE(found.residual, 1e-9);
          EXPECT_TRUE(solve(made.problem, Settings{}).converged);
          if (kind == Kind::half_space) {  // unique
            EXPECT_LT((found.lambda - made.lambda).cwiseAbs().maxCoeff(), 1e-5);
            EXPECT_LT((found.delta - made.delta).cwiseAbs().maxCoeff(), 1e-8);
          }
        }
}

// Intervals, half lines, rows that hold and rows that nothing can move beside the cones.
TEST(ConeInterior, KnowsOtherRows)
{
  const Known cones = known(Kind::half_space, 10, 0.5, 4);
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
  Known made = known(Kind::half_space, 3, 0.5, 1);
  EXPECT_TRUE(all_for_cone_interior(made.problem));
  made.problem.blocks[1].law = Law::capped_cone(0.5, 1.0);
  EXPECT_FALSE(all_for_cone_interior(made.problem));
  made.problem.blocks[1].law = Law::disc(1.0);
  EXPECT_FALSE(all_for_cone_interior(made.problem));
}

}  // namespace
}  // namespace trocar::law
