#pragma once

#include <array>
#include <span>

#include "fem/block_matrix.hpp"
#include "fem/shape.hpp"
#include "tissue/energy.hpp"

namespace trocar::tissue {

/// A vector g spread over the first eight entries (i, j) of a column-major 3x3 block: g_i in `row`,
/// g_j in `column`. Their products are the entries of dyads (see fem::SplitBlock).
struct Spread
{
  using Head = Eigen::Array<double, 8, 1>;
  Spread() = default;
  explicit Spread(const core::Vec3& g)
      : row(g[0], g[1], g[2], g[0], g[1], g[2], g[0], g[1]),
        column(g[0], g[0], g[0], g[1], g[1], g[1], g[2], g[2])
  {
  }
  Head row, column;
};

/// The blocks of  R K₀ Rᵀ + scale_m M  [N/m] of one tet, for Lamé constants λ, μ [Pa].
/// K_ab = Σ_q V (λ g_a g_bᵀ + μ g_b g_aᵀ + μ g_a·g_b I), g the shape gradients turned by R;
/// M_ab = mass_ab I. A pair (a, b) whose slot has its last bit set gets the transposed block (see
/// fem::BlockPattern::slots).
template <int N>
fem::ElementBlocks<N> operator_blocks(double lambda, double mu, const fem::PointShape<N>* shape,
                                      const Mat3* R, const Eigen::Matrix<double, N, N>& mass,
                                      double scale_m, std::span<const int> slots)
{
  constexpr int points = fem::points_per_tet<N>;
  std::array<std::array<Spread, N>, points> spread;
  std::array<Eigen::Matrix<double, 3, N>, points> g;
  std::array<double, points> lambda_V, mu_V;
  Eigen::Matrix<double, N, N> products;  // Σ_q μ V g_a·g_b, which R does not change
  for (std::size_t q = 0; q < points; ++q) {
    g[q] = R[q] * shape[q].gradient;
    for (std::size_t a = 0; a < N; ++a)
      spread[q][a] = Spread(g[q].col(static_cast<Eigen::Index>(a)));
    lambda_V[q] = lambda * shape[q].volume;
    mu_V[q] = mu * shape[q].volume;
    const Eigen::Matrix<double, 3, N> scaled = mu_V[q] * shape[q].gradient;
    if (q == 0)
      products.noalias() = shape[q].gradient.transpose() * scaled;
    else
      products.noalias() += shape[q].gradient.transpose() * scaled;
  }
  const Spread::Head diagonal(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  fem::ElementBlocks<N> blocks;
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const bool other = slots[p] & 1;
    const int a = fem::block_pairs<N>[p][other ? 1 : 0];
    const int b = fem::block_pairs<N>[p][other ? 0 : 1];
    const double equal = scale_m * mass(a, b) + products(a, b);
    blocks[p].head = equal * diagonal;
    blocks[p].last = equal;
    for (std::size_t q = 0; q < points; ++q) {
      const Spread& A = spread[q][static_cast<std::size_t>(a)];
      const Spread& B = spread[q][static_cast<std::size_t>(b)];
      blocks[p].head += lambda_V[q] * A.row * B.column + mu_V[q] * B.row * A.column;
      blocks[p].last += (lambda_V[q] + mu_V[q]) * g[q](2, a) * g[q](2, b);
    }
  }
  return blocks;
}

/// Adds scale v_a v_bᵀ to the blocks (a, b) of a tet; column a of v belongs to node a.
template <int N>
void add_rank_one(const Eigen::Matrix<double, 3, N>& v, double scale, std::span<const int> slots,
                  fem::ElementBlocks<N>& blocks)
{
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const bool other = slots[p] & 1;
    const int a = fem::block_pairs<N>[p][other ? 1 : 0];
    const int b = fem::block_pairs<N>[p][other ? 0 : 1];
    const Spread A(v.col(a)), B(v.col(b));
    blocks[p].head += scale * A.row * B.column;
    blocks[p].last += scale * v(2, a) * v(2, b);
  }
}

/// Adds the stiffness of one integration point to the blocks of a tet [N/m]. `increment(D)` returns
/// ∂P/∂F : D [Pa] for an increment D of F.
template <int N, class Increment>
void add_tangent(const fem::PointShape<N>& shape, const Increment& increment,
                 std::span<const int> slots, fem::ElementBlocks<N>& blocks)
{
  // Column k of block (a, b) is V (∂P/∂F : e_k ⊗ g_b) g_a; of_node[b][k] is the bracket.
  std::array<std::array<Mat3, 3>, N> of_node;
  for (int b = 0; b < N; ++b)
    for (int k = 0; k < 3; ++k)
      of_node[static_cast<std::size_t>(b)][static_cast<std::size_t>(k)] =
          increment(Mat3(core::Vec3::Unit(k) * shape.gradient.col(b).transpose()));
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const bool other = slots[p] & 1;
    const int a = fem::block_pairs<N>[p][other ? 1 : 0];
    const int b = fem::block_pairs<N>[p][other ? 0 : 1];
    Mat3 block;
    for (int k = 0; k < 3; ++k)
      block.col(k) =
          shape.volume * (of_node[static_cast<std::size_t>(b)][static_cast<std::size_t>(k)] *
                          shape.gradient.col(a));
    blocks[p].head += block.reshaped().template head<8>().array();
    blocks[p].last += block(2, 2);
  }
}

}  // namespace trocar::tissue
