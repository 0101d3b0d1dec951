#pragma once

#include <cmath>

#include "core/math.hpp"
#include "tissue/material.hpp"

namespace trocar::tissue {

using core::Mat3;

/// e = sym(RᵀF) - I with F = I + G. It is computed from G, because small strains lose digits in F.
inline Mat3 corotational_strain(const Mat3& R, const Mat3& G)
{
  const Mat3 stretch = R.transpose() * G + (R.transpose() - Mat3::Identity());
  return 0.5 * (stretch + stretch.transpose());
}

/// det(F) F⁻ᵀ: the derivative of det F.
inline Mat3 cofactor(const Mat3& F)
{
  Mat3 C;
  C << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
  return C;
}

/// The material laws below are all of one form, energy density ψ(F) = μ w(F) + λ/2 θ(F)², so that
/// elements may average the dilatation θ while they keep w at every point:
///   linear, corotational (Felippa 2000)  w = |e|², θ = tr e, e = sym(RᵀF) - I
///   neo-Hookean (Bonet and Wood 2008)    w = (|F|² - 3)/2 - ln J, θ = J - 1
/// First Piola stress P = μ ∂w/∂F + p ∂θ/∂F with p = λθ. R is I in linear tissue. In corotational
/// tissue derivatives are exact only if R is the polar rotation of F. All functions take the
/// displacement gradient G = F - I.
namespace energy {

/// w of the laws above, dimensionless.
inline double shear(Model model, const Mat3& R, const Mat3& G)
{
  if (model != Model::neo_hookean) return corotational_strain(R, G).squaredNorm();
  const Mat3 F = Mat3::Identity() + G;
  return 0.5 * (F.squaredNorm() - 3.0) - std::log(F.determinant());
}

/// ∂w/∂F.
inline Mat3 shear_gradient(Model model, const Mat3& R, const Mat3& G)
{
  if (model != Model::neo_hookean) return R * (2.0 * corotational_strain(R, G));
  const Mat3 F = Mat3::Identity() + G;
  return F - cofactor(F) / F.determinant();
}

/// θ of the laws above, dimensionless.
inline double dilatation(Model model, const Mat3& R, const Mat3& G)
{
  if (model != Model::neo_hookean) return R.cwiseProduct(G).sum() + (R.trace() - 3.0);
  return G.trace() + cofactor(G).trace() + G.determinant();  // J - 1
}

/// ∂θ/∂F.
inline Mat3 dilatation_gradient(Model model, const Mat3& R, const Mat3& G)
{
  return model == Model::neo_hookean ? cofactor(Mat3::Identity() + G) : R;
}

/// Increment of the polar rotation R for the increment D of F: R times the skew matrix of ω, with
/// (tr(S) I - S) ω = axial(RᵀD - DᵀR) and the stretch S = RᵀF.
inline Mat3 rotation_increment(const Mat3& R, const Mat3& G, const Mat3& D)
{
  const Mat3 S = R.transpose() + R.transpose() * G;
  const Mat3 B = R.transpose() * D;
  const core::Vec3 axial(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1));
  const Mat3 spin = S.trace() * Mat3::Identity() - 0.5 * (S + S.transpose());
  const core::Vec3 w = spin.inverse() * axial;
  Mat3 skew;
  skew << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return R * skew;
}

/// ∂²w/∂F² : D; R is held in corotational tissue unless the tangent is exact.
inline Mat3 shear_increment(Model model, Tangent tangent, const Mat3& R, const Mat3& G,
                            const Mat3& D)
{
  if (model == Model::neo_hookean) {
    const Mat3 F = Mat3::Identity() + G;
    const Mat3 back = cofactor(F) / F.determinant();  // F⁻ᵀ
    return D + back * D.transpose() * back;
  }
  if (model == Model::corotational && tangent == Tangent::exact)
    return 2.0 * (D - rotation_increment(R, G, D));
  const Mat3 stretch = R.transpose() * D;
  return R * (stretch + stretch.transpose());
}

/// ∂²θ/∂F² : D; 0 in linear tissue, and in corotational tissue unless the tangent is exact.
inline Mat3 dilatation_increment(Model model, Tangent tangent, const Mat3& R, const Mat3& G,
                                 const Mat3& D)
{
  if (model == Model::neo_hookean) {
    const Mat3 F = Mat3::Identity() + G;
    const double J = F.determinant();
    const Mat3 back = cofactor(F) / J;
    return J * (back.cwiseProduct(D).sum() * back - back * D.transpose() * back);
  }
  if (model == Model::corotational && tangent == Tangent::exact) return rotation_increment(R, G, D);
  return Mat3::Zero();
}

/// Shear part of the viscous stress over βμ, linear in the rate D of F. Neo-Hookean tissue: F·2Ė
/// with Ė = sym(FᵀD), so 2Ė is the second Piola-Kirchhoff stress. Other tissue: R·2 sym(RᵀD), the
/// shear part of R K₀ Rᵀ. As a map of D the stress is symmetric and positive semidefinite. It is
/// 2 sym(D) at F = I. It is 0 for a spin D = ωF; in corotational tissue only where the three
/// stretches are equal.
inline Mat3 viscous_shear(Model model, const Mat3& R, const Mat3& G, const Mat3& D)
{
  const Mat3 A = model == Model::neo_hookean ? Mat3(Mat3::Identity() + G) : R;
  const Mat3 rate = A.transpose() * D;
  return A * (rate + rate.transpose());
}

}  // namespace energy

/// Cauchy stress P Fᵀ / det F [Pa]. With a corotational P it is symmetric only if P was computed
/// with the polar rotation of F.
inline Mat3 cauchy_stress(const Mat3& P, const Mat3& F)
{
  return P * F.transpose() / F.determinant();
}

}  // namespace trocar::tissue
