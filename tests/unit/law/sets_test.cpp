#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/dense.hpp"
#include "law/law.hpp"

// Each set by itself: its projection, the derivative of that, its residual.
namespace trocar::law {
namespace {

constexpr double leader = 1.5;  // [N], of followers

std::vector<Law> all_laws()
{
  return {
      Law::zero(),        Law::interval(-0.4, 0.9), Law::half_line(),    Law::follower(0, 0.6),
      Law::disc(0.7),     Law::cone(0.5),           Law::cone(0.8, 1.0), Law::capped_cone(0.9, 0.6),
      Law::cone(0.0, 0.5)};
}

Few random_few(int rows, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  Few x(rows);
  for (double& value : x) value = normal(random);
  return x;
}

Few three(double n, double t1, double t2)
{
  Few x(3);
  x << n, t1, t2;
  return x;
}

Few one(double x)
{
  return Few::Constant(1, x);
}

/// Nothing of the set is nearer: (x - P x)·(y - P x) <= 0 for all y in K.
TEST(Sets, ProjectToTheNearestPoint)
{
  std::mt19937 random(3);
  for (const Law& law : all_laws())
    for (int k = 0; k < 200; ++k) {
      const Few x = random_few(law.rows(), random), on = project(law, x, leader);
      EXPECT_LT((project(law, on, leader) - on).norm(), 1e-15);
      for (int j = 0; j < 20; ++j) {
        const Few y = project(law, 3.0 * random_few(law.rows(), random), leader);
        EXPECT_LE((x - on).dot(y - on), 1e-12) << static_cast<int>(law.set);
      }
    }
}

/// What each of them is, tested by points of it and beside it.
TEST(Sets, HoldWhatTheyShould)
{
  const auto inside = [](const Law& law, const Few& x) {
    return (project(law, x, leader) - x).norm() < 1e-12;
  };
  const auto few = [](std::initializer_list<double> values) {
    Few x(static_cast<Eigen::Index>(values.size()));
    std::copy(values.begin(), values.end(), x.begin());
    return x;
  };
  EXPECT_TRUE(inside(Law::zero(), few({-1e9})));
  EXPECT_TRUE(inside(Law::half_line(), few({1e9})));
  EXPECT_FALSE(inside(Law::half_line(), few({-1e-6})));
  EXPECT_TRUE(inside(Law::follower(0, 0.6), few({-0.9})));
  EXPECT_FALSE(inside(Law::follower(0, 0.6), few({-0.91})));
  EXPECT_TRUE(inside(Law::disc(1.0), few({0.6, -0.8})));
  EXPECT_FALSE(inside(Law::disc(1.0), few({0.8, 0.8})));  // a box would hold it
  EXPECT_TRUE(inside(Law::cone(0.5), few({2.0, 0.6, 0.8})));
  EXPECT_FALSE(inside(Law::cone(0.5), few({1.9, 0.6, 0.8})));
  EXPECT_FALSE(inside(Law::cone(0.5, 1.5), few({2.0, 0.0, 0.0})));
  EXPECT_FALSE(inside(Law::capped_cone(0.5, 0.9), few({9.0, 0.6, 0.8})));
  EXPECT_TRUE(inside(Law::capped_cone(0.5, 1.1), few({9.0, 0.6, 0.8})));
}

TEST(Sets, DifferentiateTheirProjection)
{
  std::mt19937 random(5);
  constexpr double h = 1e-6;
  for (const Law& law : all_laws())
    for (int k = 0; k < 200; ++k) {
      const Few x = random_few(law.rows(), random);
      const FewSquare D = projection_derivative(law, x, leader);
      EXPECT_LT((D - D.transpose()).norm(), 1e-15);
      const VecX eigenvalues = core::symmetric_eigenvalues(MatX(D));
      EXPECT_GE(eigenvalues.minCoeff(), -1e-14);
      EXPECT_LE(eigenvalues.maxCoeff(), 1.0 + 1e-14);
      for (int j = 0; j < law.rows(); ++j) {
        Few step = Few::Zero(law.rows());
        step[j] = h;
        const Few up = project(law, x + step, leader), down = project(law, x - step, leader);
        // Within 2 h of an edge the quotient belongs to both sides of it.
        const FewSquare other = projection_derivative(law, x + 2.0 * step, leader) +
                                projection_derivative(law, x - 2.0 * step, leader) - 2.0 * D;
        if (other.norm() > 1e-3) continue;
        EXPECT_LT(((up - down) / (2.0 * h) - D.col(j)).norm(), 1e-5) << static_cast<int>(law.set);
      }
    }
}

struct State
{
  Law law;
  Few lambda, delta;
};

// Sets without width across: nothing moves there.
TEST(Sets, ThatHaveNoWidthAcrossDoNotYieldThere)
{
  const FewSquare D = projection_derivative(Law::cone(0.0, 1.0), three(0.5, 0.0, 0.0));
  EXPECT_EQ(D(0, 0), 1.0);
  EXPECT_EQ(D.norm(), 1.0);
  EXPECT_EQ(projection_derivative(Law::disc(0.0), Few::Zero(2)).norm(), 0.0);
}

/// All that rows may do: held, slipping, apart, yielding.
std::vector<State> states()
{
  Few pair(2), along(2);
  pair << 0.42, 0.56;
  along << -0.3, -0.4;
  return {{Law::zero(), one(7.0), one(0.0)},
          {Law::interval(-0.4, 0.9), one(0.3), one(0.0)},
          {Law::interval(-0.4, 0.9), one(0.9), one(-2e-3)},
          {Law::interval(-0.4, 0.9), one(-0.4), one(2e-3)},
          {Law::half_line(), one(0.0), one(1e-3)},
          {Law::follower(0, 0.6), one(0.9), one(-1e-3)},
          {Law::disc(0.7), Few(0.5 * pair), Few(Few::Zero(2))},
          {Law::disc(0.7), pair, along},
          {Law::cone(0.5), three(0.0, 0.0, 0.0), three(1e-3, 5e-3, 0.0)},  // apart, moving on
          {Law::cone(0.5), three(2.0, 0.3, 0.4), three(0.0, 0.0, 0.0)},
          {Law::cone(0.5), three(2.0, 0.6, 0.8), three(0.0, -3e-3, -4e-3)},  // slips, is not lifted
          {Law::cone(0.5, 2.0), three(2.0, 0.6, 0.8), three(-1e-3, -3e-3, -4e-3)},  // and yields
          {Law::capped_cone(0.5, 0.5), three(9.0, 0.3, 0.4), three(0.0, -3e-3, -4e-3)}};
}

TEST(Sets, HaveNoResidualWhereTheirLawIsMet)
{
  for (const State& s : states())
    EXPECT_LT(residual(s.law, s.lambda, s.delta, 2e-3, leader), 1e-17)
        << static_cast<int>(s.law.set) << ' ' << s.lambda.transpose();
}

/// A gap that is off by ε where a row holds, or a force that should not be, is told in metres.
TEST(Sets, TellTheirResidualInMetres)
{
  constexpr double w = 2e-3, off = 1e-6;
  for (const State& s : states()) {
    if (s.delta.norm() == 0.0) {
      const Few moved = s.delta + Few::Constant(s.law.rows(), off);
      const double expected = off * std::sqrt(s.law.rows());
      EXPECT_NEAR(residual(s.law, s.lambda, moved, w, leader), expected, 0.3 * expected)
          << static_cast<int>(s.law.set);
    } else {
      const Few changed = 0.9 * s.lambda + Few::Constant(s.law.rows(), 1e-3);
      EXPECT_GT(residual(s.law, changed, s.delta, w, leader), 0.1 * w * 1e-3)
          << static_cast<int>(s.law.set);
    }
  }
  // Of a cone that lifts where it slips, a law normal to the whole cone would not take notice.
  EXPECT_NEAR(residual(Law::cone(0.5), three(2.0, 0.6, 0.8), three(2.5e-3, -3e-3, -4e-3), w), 0.0,
              4e-3);
  EXPECT_GT(residual(Law::cone(0.5), three(2.0, 0.6, 0.8), three(2.5e-3, -3e-3, -4e-3), w), 1e-3);
}

// What nothing can move bears the end of its set against the gap, a cone its normal force first.
TEST(Sets, ResistAGapWithTheirEnds)
{
  EXPECT_EQ(resisting(Law::box(2.0), one(1e-9))[0], -2.0);
  EXPECT_EQ(resisting(Law::interval(0.0, 3.0), one(-1e-9))[0], 3.0);
  EXPECT_EQ(resisting(Law::interval(0.0, 3.0), one(1e-9))[0], 0.0);
  EXPECT_EQ(resisting(Law::half_line(), one(-1.0))[0], std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(resisting(Law::follower(0, 0.6), one(1.0), leader)[0], -0.9);
  EXPECT_LT((resisting(Law::cone(0.5, 2.0), three(-1, 3, 4)) - three(2.0, -0.6, -0.8)).norm(),
            1e-15);
  EXPECT_EQ(resisting(Law::cone(0.5, 2.0), three(1, 3, 4)).norm(), 0.0);
}

}  // namespace
}  // namespace trocar::law
