#pragma once

#include "core/math.hpp"

namespace trocar::needle {

using core::Mat3;
using core::Vec3;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Vec12 = Eigen::Matrix<double, 12, 1>;

/// Circular section, solid when inner is 0 [m], with its elastic constants [Pa].
struct Section
{
  double outer = 0.0, inner = 0.0;
  double young = 0.0, poisson = 0.0;

  double area() const;           ///< A [m²]
  double second_moment() const;  ///< I [m⁴]
  double polar_moment() const { return 2.0 * second_moment(); }
  double shear_modulus() const { return young / (2.0 * (1.0 + poisson)); }
  /// κ of a circular section (Cowper 1966): 6(1+ν)/(7+6ν) solid, its tube formula else.
  double shear_factor() const;
};

/// Timoshenko stiffness of a straight element of length L along its x axis (Przemieniecki 1968),
/// dofs (u_x u_y u_z θ_x θ_y θ_z) of both ends [N/m, N, N m].
Mat12 beam_stiffness(const Section& section, double length);

/// Pose of one end of an element: position [m] and rotation from the rest frame.
struct EndPose
{
  Vec3 x;
  Mat3 R;
};

/// Forces the element puts up and a symmetric positive semidefinite tangent of them in world axes
/// (corotational). Of the derivative of the element frame only the string stiffness of a tension
/// is kept: the rest is not symmetric or not positive, and costs iterations where the step is
/// iterated.
struct BeamForce
{
  Vec12 force;
  Mat12 tangent;
  double energy;  ///< [J]
};
/// `local` is `beam_stiffness`; frames are relative to a rest frame whose first column lies along
/// the element.
BeamForce corotational_beam(const Mat12& local, double length, const EndPose& a, const EndPose& b);

}  // namespace trocar::needle
