#pragma once

#include "core/math.hpp"
#include "fem/block_matrix.hpp"
#include "fem/shape.hpp"

namespace trocar::tissue {

using core::Mat3;

/// Isotropic linear elasticity and mass of one tissue.
struct Material
{
  double young = 5000.0;            ///< E [Pa]
  double poisson = 0.45;            ///< ν, < 0.5
  double density = 1000.0;          ///< ρ [kg/m³]
  double rayleigh_mass = 0.0;       ///< α [1/s] in B = αM + βK
  double rayleigh_stiffness = 0.0;  ///< β [s]

  double lambda() const  ///< first Lamé constant [Pa]
  {
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  }
  double mu() const { return young / (2.0 * (1.0 + poisson)); }  ///< shear modulus [Pa]
};

/// Gradient sum_a w_a ⊗ grad N_a of nodal vectors (3x4, one column per node); F = I + that of u.
inline Mat3 nodal_gradient(const fem::TetShape& shape, const Eigen::Matrix<double, 3, 4>& nodal)
{
  return nodal * shape.gradient.transpose();
}

/// e = sym(RᵀF) - I.
inline Mat3 corotational_strain(const Mat3& R, const Mat3& F)
{
  const Mat3 stretch = R.transpose() * F;
  return 0.5 * (stretch + stretch.transpose()) - Mat3::Identity();
}

/// 2μ|e|² + λ tr(e)² [Pa]: twice the energy density of the strain e.
inline double strain_square(const Material& m, const Mat3& e)
{
  return 2.0 * m.mu() * e.squaredNorm() + m.lambda() * e.trace() * e.trace();
}

/// Corotational first Piola stress P = R (2μ e + λ tr(e) I) [Pa], e = sym(RᵀF) - I, with stiffness
/// damping folded in: e gains β sym(Rᵀ dF/dt). R = I gives linear elasticity (Felippa 2000).
/// The exact derivative of the energy V (μ|e|² + λ/2 tr(e)²) when R is the polar rotation of F.
inline Mat3 stress(const Material& m, const Mat3& R, const Mat3& F, const Mat3& F_rate)
{
  const Mat3 e = corotational_strain(R, F + m.rayleigh_stiffness * F_rate);
  return R * (2.0 * m.mu() * e + m.lambda() * e.trace() * Mat3::Identity());
}

/// Cauchy stress P Fᵀ / det F [Pa]; symmetric when P is that of the polar rotation of F.
inline Mat3 cauchy_stress(const Mat3& P, const Mat3& F)
{
  return P * F.transpose() / F.determinant();
}

/// g ⊗ 1 and 1 ⊗ g on the entries of a column-major 3x3 block: g by row, and g by column.
struct Spread
{
  using Head = Eigen::Array<double, 8, 1>;
  explicit Spread(const core::Vec3& g)
      : row(g[0], g[1], g[2], g[0], g[1], g[2], g[0], g[1]),
        column(g[0], g[0], g[0], g[1], g[1], g[1], g[2], g[2])
  {
  }
  Head row, column;
};

/// The ten blocks of  scale_k R K₀ Rᵀ + scale_m M  [N/m] of one tet.
/// K_ab = V (λ g_a g_bᵀ + μ g_b g_aᵀ + μ g_a·g_b I), g the shape gradients turned by R;
/// M_ab = ρV (1 + δ_ab)/20 consistent or ρV δ_ab/4 lumped. Bit p of `transposed`: K_ba instead.
inline fem::ElementBlocks operator_blocks(const Material& m, const fem::TetShape& shape,
                                          const Mat3& R, double scale_k, double scale_m,
                                          bool lumped, std::uint16_t transposed)
{
  const Eigen::Matrix<double, 3, 4> g = R * shape.gradient;
  const Eigen::Matrix4d products = shape.gradient.transpose() * shape.gradient;
  const std::array<Spread, 4> spread{Spread(g.col(0)), Spread(g.col(1)), Spread(g.col(2)),
                                     Spread(g.col(3))};
  const double lambda = scale_k * shape.volume * m.lambda();
  const double mu = scale_k * shape.volume * m.mu();
  const double mass = scale_m * shape.volume * m.density;
  const double off = lumped ? 0.0 : mass / 20.0;
  const double own = lumped ? mass / 4.0 : mass / 10.0;
  const Spread::Head diagonal(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  fem::ElementBlocks blocks;
  for (std::size_t p = 0; p < 10; ++p) {
    const bool other = transposed >> p & 1U;
    const int a = fem::block_pairs[p][other ? 1 : 0];
    const int b = fem::block_pairs[p][other ? 0 : 1];
    const Spread& A = spread[static_cast<std::size_t>(a)];
    const Spread& B = spread[static_cast<std::size_t>(b)];
    const double equal = mu * products(a, b) + (a == b ? own : off);
    blocks[p].head = lambda * A.row * B.column + mu * B.row * A.column + equal * diagonal;
    blocks[p].last = (lambda + mu) * g(2, a) * g(2, b) + equal;
  }
  return blocks;
}

}  // namespace trocar::tissue
