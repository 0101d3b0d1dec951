#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "needle/needle.hpp"

namespace trocar::needle {
namespace {

constexpr double length = 0.12, density = 7850.0, radius = 0.002;
constexpr double mass = density * std::numbers::pi * radius * radius * length;

NeedleSettings steel(Model model)
{
  NeedleSettings settings;
  settings.name = "test";
  settings.model = model;
  settings.motion.length = length;
  settings.section = {radius, 0.0, 2e11, 0.3};
  settings.density = density;
  settings.elements = 10;
  return settings;
}

// A needle held out horizontally: the holder carries its weight, and turns against it with half the
// length for an arm.
TEST(Holder, TurnsAgainstTheWeight)
{
  for (Model model : {Model::rigid, Model::beam}) {
    NeedleSettings settings = steel(model);
    settings.gravity = Vec3(0.0, 0.0, -9.81);
    const Needle needle(settings);
    const NeedleState start = needle.initial();
    const VecX nothing = VecX::Zero(needle.dofs());
    const Linearised linear = needle.linearise(start, start, {0.0, 1.0, true});
    const Wrench wrench = needle.base_wrench(start, linear, nothing);
    EXPECT_LT((wrench.force - Vec3(0.0, 0.0, 9.81 * mass)).norm(), 1e-9 * 9.81 * mass);
    EXPECT_LT((wrench.moment - Vec3(0.0, -0.5 * length * 9.81 * mass, 0.0)).norm(),
              1e-9 * length * 9.81 * mass);
  }
}

// A needle rolled about its axis: to set it going takes its moment of inertia ½ m r² times the
// rate, to keep it going nothing.
TEST(Holder, RollsTheNeedleAgainstItsInertiaAlone)
{
  NeedleSettings settings = steel(Model::rigid);
  settings.motion.trajectory = core::parse_csv(
      "time,x,y,z,dx,dy,dz,roll\n0,-0.12,0,0,1,0,0,0\n1,-0.12,0,0,1,0,0,2\n", "roll.csv");
  const Needle needle(settings);
  const VecX nothing = VecX::Zero(needle.dofs());
  const double h = 0.1, rate = 2.0, inertia = 0.5 * mass * radius * radius;
  NeedleState state = needle.initial();
  for (int n = 1; n <= 3; ++n) {
    const core::TimeStep now{n * h, h, false};
    const NeedleState moved = needle.predict(state, now.t);
    const Linearised linear = needle.linearise(state, moved, now);
    const Vec3 moment = needle.base_wrench(moved, linear, nothing).moment;
    const double expected = n == 1 ? inertia * rate / h : 0.0;
    EXPECT_LT((moment - Vec3(expected, 0.0, 0.0)).norm(), 1e-9 * inertia * rate / h) << n;
    state = needle.correct(state, moved, linear, nothing, now);
    EXPECT_NEAR(needle.energy(state, state).kinetic, 0.5 * inertia * rate * rate,
                1e-9 * inertia * rate * rate);
  }
}

// A roll in a trajectory turns the needle about its own axis as a roll at the start does, the
// positive way round.
TEST(Motion, RollsTheSameWayFromTheStartAndLater)
{
  const Vec3 aim = Vec3(1.0, 2.0, -0.5).normalized();
  BaseMotion rolled, later;
  rolled.length = later.length = length;
  rolled.direction = later.direction = aim;
  rolled.roll = 0.7;
  const auto row = [&](double t, double roll) {
    const Vec3 x = -length * aim;
    return std::vector<double>{t, x.x(), x.y(), x.z(), aim.x(), aim.y(), aim.z(), roll};
  };
  later.trajectory = core::Csv{"roll.csv",
                               {"time", "x", "y", "z", "dx", "dy", "dz", "roll"},
                               {row(0.0, 0.0), row(1.0, 0.7)}};
  EXPECT_LT((later.at(1.0).R - rolled.start().R).norm(), 1e-12);
  const Mat3 turn = later.at(1.0).R * later.at(0.0).R.transpose();
  EXPECT_LT((core::rotation_log(turn) - 0.7 * aim).norm(), 1e-12);
}

}  // namespace
}  // namespace trocar::needle
