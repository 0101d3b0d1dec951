#pragma once

#include "core/math.hpp"

namespace trocar::needle {

using core::Mat3;
using core::Vec3;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Vec12 = Eigen::Matrix<double, 12, 1>;

/// Circular cross-section: outer and inner radius [m] (inner 0: solid), Young's modulus [Pa] and
/// Poisson's ratio.
struct Section
{
  double outer = 0.0, inner = 0.0;
  double young = 0.0, poisson = 0.0;

  double area() const;           ///< A [m²]
  double second_moment() const;  ///< I [m⁴]
  double polar_moment() const { return 2.0 * second_moment(); }
  double shear_modulus() const { return young / (2.0 * (1.0 + poisson)); }
  /// Shear factor κ (Cowper 1966): 6(1+ν)/(7+6ν) for a solid circle, Cowper's formula for a hollow
  /// circle otherwise.
  double shear_factor() const;
};

/// Stiffness matrix of a straight Timoshenko beam element along its x axis (Przemieniecki 1968).
/// Dofs: (u_x u_y u_z θ_x θ_y θ_z) of the first end, then of the second [N/m, N, N m].
Mat12 beam_stiffness(const Section& section, double length);

/// Pose of one end of an element: position [m] and nodal frame. In the straight element at rest the
/// first column of the frame lies along the element.
struct EndPose
{
  Vec3 x;
  Mat3 R;
};

/// Internal force of a corotational element and its tangent in world axes, dofs as in
/// `beam_stiffness`. The tangent is symmetric positive semidefinite: of the derivative of the
/// element frame it keeps only the string stiffness of an element in tension. The rest of this
/// derivative is not symmetric or not positive. Without it Newton's method takes more iterations.
struct BeamForce
{
  Vec12 force;
  Mat12 tangent;
  double energy;  ///< elastic energy [J]
};
/// Internal force, tangent and energy of the element between the poses a and b. `local`: result of
/// `beam_stiffness`; `length`: at rest [m].
BeamForce corotational_beam(const Mat12& local, double length, const EndPose& a, const EndPose& b);

}  // namespace trocar::needle
