#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "needle/beam_element.hpp"
#include "support/dense.hpp"

namespace trocar::needle {
namespace {

constexpr double pi = std::numbers::pi;

// A disc and a tube in numbers of their own; of a thin tube πr t, πr³t and Cowper's 2(1+ν)/(4+3ν).
TEST(Section, HasItsClosedForms)
{
  const Section solid{0.003, 0.0, 2e11, 0.3};
  EXPECT_NEAR(solid.area(), 9e-6 * pi, 1e-18);
  EXPECT_NEAR(solid.second_moment(), 81e-12 * pi / 4.0, 1e-24);
  EXPECT_NEAR(solid.polar_moment(), 81e-12 * pi / 2.0, 1e-24);
  EXPECT_NEAR(solid.shear_factor(), 6.0 * 1.3 / (7.0 + 6.0 * 0.3), 1e-14);
  const Section tube{0.003, 0.002, 2e11, 0.3};
  EXPECT_NEAR(tube.area(), (9e-6 - 4e-6) * pi, 1e-18);
  EXPECT_NEAR(tube.second_moment(), (81e-12 - 16e-12) * pi / 4.0, 1e-24);
  const double r = 0.003, t = 1e-9;
  const Section thin{r, r - t, 2e11, 0.3};
  EXPECT_NEAR(thin.area() / (2.0 * pi * r * t), 1.0, 1e-5);
  EXPECT_NEAR(thin.second_moment() / (pi * r * r * r * t), 1.0, 1e-5);
  EXPECT_NEAR(thin.shear_factor(), 2.0 * 1.3 / (4.0 + 3.0 * 0.3), 1e-6);
}

// What the end of an element, held at its other end, gives way to unit loads: stretch, deflection
// with shear, twist, and the slope that goes with a deflection.
TEST(Section, GivesTheElementTextbookCompliance)
{
  const double r = 0.01, E = 1e6, nu = 0.25, L = 0.05;
  const double A = pi * r * r, I = pi * std::pow(r, 4) / 4.0, J = 2.0 * I, G = E / (2.0 * (1 + nu));
  const double kappa = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
  const Mat12 K = beam_stiffness({r, 0.0, E, nu}, L);
  const core::MatX C = test::inverse(K.bottomRightCorner<6, 6>());
  const double bend = L * L * L / (3.0 * E * I) + L / (kappa * G * A);
  EXPECT_NEAR(C(0, 0) / (L / (E * A)), 1.0, 1e-12);
  EXPECT_NEAR(C(1, 1) / bend, 1.0, 1e-12);
  EXPECT_NEAR(C(2, 2) / bend, 1.0, 1e-12);
  EXPECT_NEAR(C(3, 3) / (L / (G * J)), 1.0, 1e-12);
  EXPECT_NEAR(C(5, 1) / (L * L / (2.0 * E * I)), 1.0, 1e-12);
  EXPECT_NEAR(C(4, 2) / (-L * L / (2.0 * E * I)), 1.0, 1e-12);
  EXPECT_NEAR(C(5, 5) / (L / (E * I)), 1.0, 1e-12);
}

// Bent, stretched and twisted by a lot: seen from its other end the element stores the same and
// pushes the same.
TEST(Beam, LooksTheSameFromEitherEnd)
{
  const double L = 0.05;
  const Mat12 K = beam_stiffness({0.01, 0.004, 1e6, 0.25}, L);
  const EndPose a{Vec3(0.01, -0.02, 0.03), core::rotation_exp(Vec3(0.5, -0.3, 0.2))};
  const EndPose b{a.x + L * Vec3(0.9, 0.5, 0.2), core::rotation_exp(Vec3(1.1, 0.2, 0.6))};
  const Mat3 back = Vec3(-1.0, 1.0, -1.0).asDiagonal();  // half a turn about y
  const BeamForce one = corotational_beam(K, L, a, b);
  const BeamForce other = corotational_beam(K, L, {b.x, b.R * back}, {a.x, a.R * back});
  EXPECT_NEAR(other.energy, one.energy, 1e-12 * one.energy);
  EXPECT_LT((other.force.head<6>() - one.force.tail<6>()).norm(), 1e-12 * one.force.norm());
  EXPECT_LT((other.force.tail<6>() - one.force.head<6>()).norm(), 1e-12 * one.force.norm());
}

}  // namespace
}  // namespace trocar::needle
