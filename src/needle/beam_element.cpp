#include "needle/beam_element.hpp"

#include <cmath>
#include <numbers>
#include <tuple>

namespace trocar::needle {

double Section::area() const
{
  return std::numbers::pi * (outer * outer - inner * inner);
}

double Section::second_moment() const
{
  return std::numbers::pi / 4.0 * (std::pow(outer, 4) - std::pow(inner, 4));
}

double Section::shear_factor() const
{
  const double m = inner / outer;
  const double q = (1.0 + m * m) * (1.0 + m * m);
  return 6.0 * (1.0 + poisson) * q / ((7.0 + 6.0 * poisson) * q + (20.0 + 12.0 * poisson) * m * m);
}

Mat12 beam_stiffness(const Section& section, double L)
{
  const double EI = section.young * section.second_moment();
  const double GA = section.shear_factor() * section.shear_modulus() * section.area();
  const double phi = 12.0 * EI / (GA * L * L);
  const double bend = EI / ((1.0 + phi) * L * L * L);
  const double stretch = section.young * section.area() / L;
  const double twist = section.shear_modulus() * section.polar_moment() / L;
  Mat12 K = Mat12::Zero();
  const auto put = [&K](int i, int j, double value) {
    K(i, j) = value;
    K(j, i) = value;
  };
  for (const auto& [dof, k] : {std::pair{0, stretch}, std::pair{3, twist}}) {
    put(dof, dof, k);
    put(dof + 6, dof + 6, k);
    put(dof, dof + 6, -k);
  }
  // Bending in the xy plane couples u_y with θ_z. Bending in the xz plane couples u_z with θ_y; its
  // coupling terms have the opposite sign.
  for (const auto& [u, r, sign] : {std::tuple{1, 5, 1.0}, std::tuple{2, 4, -1.0}}) {
    put(u, u, 12.0 * bend);
    put(u + 6, u + 6, 12.0 * bend);
    put(u, u + 6, -12.0 * bend);
    put(u, r, sign * 6.0 * bend * L);
    put(u, r + 6, sign * 6.0 * bend * L);
    put(u + 6, r, -sign * 6.0 * bend * L);
    put(u + 6, r + 6, -sign * 6.0 * bend * L);
    put(r, r, (4.0 + phi) * bend * L * L);
    put(r + 6, r + 6, (4.0 + phi) * bend * L * L);
    put(r, r + 6, (2.0 - phi) * bend * L * L);
  }
  return K;
}

BeamForce corotational_beam(const Mat12& local, double length, const EndPose& a, const EndPose& b)
{
  const Vec3 chord = b.x - a.x;
  const double l = chord.norm();
  Mat3 frame;
  frame.col(0) = chord / l;
  const Vec3 y = a.R.col(1) + b.R.col(1);
  frame.col(1) = (y - frame.col(0) * frame.col(0).dot(y)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));

  Vec12 u = Vec12::Zero();
  u[6] = l - length;
  u.segment<3>(3) = core::rotation_log(frame.transpose() * a.R);
  u.segment<3>(9) = core::rotation_log(frame.transpose() * b.R);
  Mat12 turn = Mat12::Zero();
  for (int k = 0; k < 4; ++k) turn.block<3, 3>(3 * k, 3 * k) = frame;
  const Vec12 force = local * u;
  BeamForce result{turn * force, turn * local * turn.transpose(), 0.5 * u.dot(force)};
  if (const double tension = force[6]; tension > 0.0) {
    const Mat3 across = tension / l * (Mat3::Identity() - frame.col(0) * frame.col(0).transpose());
    for (const auto& [i, j, sign] :
         {std::tuple{0, 0, 1.0}, {6, 6, 1.0}, {0, 6, -1.0}, {6, 0, -1.0}})
      result.tangent.block<3, 3>(i, j) += sign * across;
  }
  return result;
}

}  // namespace trocar::needle
