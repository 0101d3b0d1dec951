#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/failure.hpp"
#include "needle/needle.hpp"

namespace trocar::needle {
namespace {

NeedleSettings steel(int elements)
{
  NeedleSettings settings;
  settings.name = "test";
  settings.motion.length = 0.12;
  settings.section = {0.0005, 0.0, 2e11, 0.3};
  settings.elements = elements;
  return settings;
}

/// Static equilibrium under nodal loads (dofs), by Newton with load steps.
NeedleState equilibrium(const Needle& needle, const VecX& load, int steps)
{
  const core::TimeStep now{0.0, 1.0, true};
  NeedleState state = needle.initial();
  for (int k = 1; k <= steps; ++k)
    for (int iteration = 0; iteration < 200; ++iteration) {
      const Linearised linear = needle.linearise(state, state, now);
      const VecX coupling = -static_cast<double>(k) / steps * load;  // the needle feels minus it
      if (needle.relative_increment(linear, coupling) < 1e-12) break;
      state = needle.correct(state, state, linear, coupling, now);
    }
  return state;
}

TEST(Beam, CantileverBendsByTimoshenkoWithAnyNumberOfElements)
{
  for (int elements : {1, 3, 20}) {
    const Needle needle(steel(elements));
    const Section& s = needle.settings().section;
    const double L = needle.settings().motion.length, P = 1e-7;
    VecX load = VecX::Zero(needle.dofs());
    load[6 * elements + 2] = P;
    const NeedleState state = equilibrium(needle, load, 1);
    const double EI = s.young * s.second_moment();
    const double GA = s.shear_factor() * s.shear_modulus() * s.area();
    // The element is exact at its nodes; what is left is the geometry, (w/L)² ~ 1e-11.
    EXPECT_NEAR(state.shaft.tip().z() / (P * L * L * L / (3 * EI) + P * L / GA), 1.0, 1e-8);
    EXPECT_NEAR(core::rotation_log(state.shaft.R.back() * state.shaft.R.front().transpose()).y() /
                    (-P * L * L / (2 * EI)),
                1.0, 1e-8);
  }
}

TEST(Beam, ThickCantileverShowsItsShear)
{
  NeedleSettings settings = steel(2);
  settings.section = {0.02, 0.01, 1e6, 0.25};
  const Needle needle(settings);
  const double L = settings.motion.length, P = 1e-4;
  VecX load = VecX::Zero(needle.dofs());
  load[13] = P;
  const double EI = 1e6 * settings.section.second_moment();
  const double GA =
      settings.section.shear_factor() * settings.section.shear_modulus() * settings.section.area();
  EXPECT_GT(L / GA / (L * L * L / (3 * EI)), 0.05);  // shear matters here
  EXPECT_NEAR(
      equilibrium(needle, load, 1).shaft.tip().y() / (P * L * L * L / (3 * EI) + P * L / GA), 1.0,
      1e-5);
}

TEST(Beam, RollsUpToAFullCircleUnderItsClosedFormMoment)
{
  const Needle needle(steel(20));
  const Section& s = needle.settings().section;
  const double L = needle.settings().motion.length;
  const double full = 2.0 * std::numbers::pi * s.young * s.second_moment() / L;
  VecX load = VecX::Zero(needle.dofs());
  load[6 * 20 + 5] = full / 2;
  const Vec3 base = needle.initial().shaft.x.front();
  const NeedleState half = equilibrium(needle, load, 20);
  // Half a circle: the tip is one diameter 2 L / pi away, straight across. The polygon of 20
  // chords has this diameter up to (pi/20)²/24.
  EXPECT_NEAR((half.shaft.tip() - base).y(), 2.0 * L / std::numbers::pi, 2e-3 * L);
  EXPECT_NEAR((half.shaft.tip() - base).x(), 0.0, 2e-3 * L);
  load[6 * 20 + 5] = full;
  const NeedleState circle = equilibrium(needle, load, 40);
  EXPECT_LT((circle.shaft.tip() - base).norm(), 1e-6 * L);
}

TEST(Beam, ElasticaFollowsTheTabulatedLargeDeflections)
{
  // Cantilever with a dead tip load, P L² / EI = 1, 2, 5: Bisshopp and Drucker (1945).
  const Needle needle(steel(40));
  const Section& s = needle.settings().section;
  const double L = needle.settings().motion.length, EI = s.young * s.second_moment();
  const double table[3][3] = {{1, 0.3017, 0.0564}, {2, 0.4935, 0.1606}, {5, 0.7138, 0.3876}};
  for (const auto& [load, w, u] : table) {
    VecX f = VecX::Zero(needle.dofs());
    f[6 * 40 + 1] = load * EI / (L * L);
    const NeedleState state = equilibrium(needle, f, 10);
    EXPECT_NEAR((state.shaft.tip() - state.shaft.x.front()).y() / L, w, 2e-3);
    EXPECT_NEAR(1.0 - (state.shaft.tip() - state.shaft.x.front()).x() / L, u, 2e-3);
  }
}

TEST(Beam, RigidMotionCostsNoForce)
{
  const Needle needle(steel(5));
  NeedleState state = needle.initial();
  const Mat3 Q = core::rotation_exp(Vec3(0.3, -2.0, 1.0));
  for (std::size_t i = 0; i < state.shaft.x.size(); ++i) {
    state.shaft.x[i] = Q * state.shaft.x[i] + Vec3(1, 2, 3);
    state.shaft.R[i] = Q * state.shaft.R[i];
  }
  const Linearised linear = needle.linearise(state, state, {0, 1, true});
  EXPECT_LT(linear.r.cwiseAbs().maxCoeff(), 1e-12 * linear.A.cwiseAbs().maxCoeff());
  EXPECT_LT((linear.A - linear.A.transpose()).norm(), 1e-12 * linear.A.norm());
}

TEST(Needle, TheHolderCarriesWeightAndInertia)
{
  for (Model model : {Model::rigid, Model::beam}) {
    NeedleSettings settings = steel(10);
    settings.model = model;
    settings.density = 7850;
    settings.gravity = Vec3(0, 0, -9.81);
    settings.motion.velocity = 0.1;
    settings.motion.depth = 0.1;
    const Needle needle(settings);
    const double mass = 7850 * settings.section.area() * settings.motion.length;
    const core::TimeStep now{0.01, 0.01, false};
    const NeedleState start = needle.initial();
    const NeedleState moved = needle.predict(start, now.t);
    const Linearised linear = needle.linearise(start, moved, now);
    const Wrench wrench = needle.base_wrench(moved, linear, VecX::Zero(needle.dofs()));
    const NeedleState end = needle.correct(start, moved, linear, VecX::Zero(needle.dofs()), now);
    Vec3 momentum = Vec3::Zero();
    for (std::size_t i = 0; i < end.v.size(); ++i)
      momentum += mass / 10.0 * (i == 0 || i == 10 ? 0.5 : 1.0) * end.v[i];
    const Vec3 expected = momentum / now.h - mass * settings.gravity;
    EXPECT_LT((wrench.force - expected).norm(), 1e-9 * expected.norm());
  }
}

Shaft bent()
{
  const Needle needle(steel(6));
  VecX load = VecX::Zero(needle.dofs());
  load[6 * 6 + 1] = 0.5;
  load[6 * 6 + 2] = -0.3;
  return equilibrium(needle, load, 5).shaft;
}

TEST(Shaft, IsC1AndProjectionFindsTheNearestPoint)
{
  const Shaft shaft = bent();
  for (int e = 1; e < 6; ++e) {
    const double s = e * shaft.element_length();
    EXPECT_LT((shaft_at(shaft, s - 1e-9).tangent - shaft_at(shaft, s + 1e-9).tangent).norm(), 1e-6);
  }
  for (double s : {0.001, 0.017, 0.02, 0.055, 0.1199}) {
    const ShaftPoint on = shaft_at(shaft, s);
    const ShaftPoint found = project(shaft, on.x + 0.003 * on.normal_1 - 0.001 * on.normal_2);
    EXPECT_NEAR(found.s, s, 1e-10);
    const Vec3 along = shaft_at(shaft, s + 5e-7).x - shaft_at(shaft, s - 5e-7).x;
    EXPECT_LT((on.tangent - along.normalized()).norm(), 1e-7);
    EXPECT_NEAR(on.tangent.dot(on.normal_1), 0.0, 1e-14);
    EXPECT_NEAR(on.normal_1.cross(on.normal_2).dot(on.tangent), 1.0, 1e-14);
  }
  // Beyond the tip the end tangent goes on.
  EXPECT_NEAR(project(shaft, shaft.tip() + 0.01 * shaft.R.back().col(0)).s, shaft.length + 0.01,
              1e-12);
}

TEST(Shaft, LeverIsTheDerivativeOfThePosition)
{
  const Shaft shaft = bent();
  const Vec3 d = Vec3(0.2, -0.5, 0.9).normalized();
  for (double s : {0.004, 0.05, 0.12, 0.127}) {
    VecX row = VecX::Zero(6 * 7);
    for (const auto& [dof, value] : jacobian(shaft, s, d)) row[dof] += value;
    for (int node = 0; node < 7; ++node)
      for (int k = 0; k < 6; ++k) {
        const auto moved = [&](double by) {
          Shaft other = shaft;
          const auto n = static_cast<std::size_t>(node);
          if (k < 3)
            other.x[n][k] += by;
          else
            other.R[n] = core::rotation_exp(by * Vec3::Unit(k - 3)) * other.R[n];
          return d.dot(shaft_at(other, s).x);
        };
        EXPECT_NEAR(row[6 * node + k], (moved(1e-6) - moved(-1e-6)) / 2e-6, 1e-8);
      }
  }
}

TEST(Motion, AdvancesHoldsAndWithdraws)
{
  BaseMotion m;
  m.length = 0.1;
  m.direction = Vec3(0, 0, -1);
  m.velocity = 0.02;
  m.depth = 0.05;
  m.hold = 1.0;
  m.withdraw_velocity = 0.01;
  const auto tip = [&](double t) { return -(m.at(t).x.z() - m.length); };
  EXPECT_NEAR(tip(0.0), 0.0, 1e-15);
  EXPECT_NEAR(tip(1.0), 0.02, 1e-15);
  EXPECT_NEAR(tip(3.0), 0.05, 1e-15);
  EXPECT_NEAR(tip(4.5), 0.04, 1e-15);
  m.velocity = 0.0;
  m.withdraw_velocity = 0.0;
  EXPECT_EQ(tip(9.0), 0.0);
}

TEST(Motion, TrajectoriesAreCheckedAndTurnTheBase)
{
  BaseMotion m;
  m.length = 0.1;
  m.trajectory = core::parse_csv(
      "time,x,y,z,dx,dy,dz,roll\n0,-0.1,0,0,1,0,0,0\n1,0,0,0,0,1,0,1.5707963267948966\n", "m.csv");
  EXPECT_NO_THROW(check_trajectory(m));
  const Pose end = m.at(1.0);
  EXPECT_LT((end.R.col(0) - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((m.at(0.0).R - m.start().R).norm(), 1e-12);
  for (const char* bad : {"time,x,y,z\n0,0,0,0\n", "time,x,y\n0,0,0\n", "t,x,y,z\n0,-0.1,0,0\n",
                          "time,x,y,z,dx,dy,dz\n0,-0.1,0,0,0,0,0\n"}) {
    m.trajectory = core::parse_csv(bad, "m.csv");
    EXPECT_THROW(check_trajectory(m), core::Failure) << bad;
  }
}

}  // namespace
}  // namespace trocar::needle
