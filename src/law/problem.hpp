#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

/// The law of one constraint row.
enum class RowKind : std::uint8_t {
  bilateral,  ///< δ = 0, λ free
  box,        ///< |λ| <= F;  stick: δ = 0;  slip: λ = -F sign(δ)
  push        ///< 0 <= λ <= F;  contact: δ = 0;  apart: δ > 0, λ = 0;  yielding: δ < 0, λ = F
};

/// The dense problem  δ = W λ + g, (δ, λ) in every row's law  (DESIGN eq., paper eq. 3).
/// With fixed bounds it is the optimality system of min ½ λᵀWλ + gᵀλ over the box.
struct Problem
{
  MatX W;                     ///< compliance (rows x rows) [m/N], symmetric positive semidefinite
  VecX g;                     ///< violation after free motion (rows) [m]
  std::vector<RowKind> kind;  ///< per row
  VecX bound;                 ///< F >= 0 (rows) [N]; ignored on bilateral rows
  /// Rows whose bound follows another multiplier, F = friction · max(λ_normal, 0): the row's index
  /// or -1 (rows, or empty: all bounds fixed), and the coefficient.
  std::vector<int> normal;
  VecX friction;
  /// Smooth rows: a bilateral row with softness c obeys δ = -c λ, a linear dashpot or spring
  /// (rows, or empty: all hard) [m/N].
  VecX softness;
  std::vector<int> group;  ///< coupling point of each row, ascending: PGS solves them together
  VecX start;              ///< multipliers to start from (rows) [N]

  Eigen::Index rows() const { return g.size(); }
};

enum class Method { automatic, pgs, hybrid, active_set, interior_point };

/// What the iterative methods stop on. The residual is true, the step norm is the paper's.
enum class Norm { residual, step };

struct Settings
{
  Method method = Method::automatic;
  Norm norm = Norm::residual;
  double tolerance = 1e-9;  ///< [m]
  int max_iterations = 1000;
};

/// The solution, and how good it is.
struct Multipliers
{
  VecX lambda;  ///< (rows) [N]
  VecX delta;   ///< W λ + g (rows) [m]
  bool converged = false;
  std::string why;         ///< when not converged: one line for the log
  int iterations = 0;      ///< sweeps, or factorisations with those of a fallback included
  int outer = 1;           ///< solves with fixed bounds until state-dependent ones settled
  double contraction = 0;  ///< ratio of their last two changes, < 1 when they settle
  double residual = 0.0;   ///< true KKT residual [m], see `kkt_residual`
  int rank = 0;            ///< numerical rank of W
  double condition = 0.0;  ///< of the kept bilateral rows, at least (0: not found, or none)
  bool nonunique = false;  ///< single λ are not unique (δ, forces and work are)
  int immovable = -1;      ///< row that nothing can move and whose law its gap breaks; -1: none
  double seconds = 0.0;    ///< wall time of the iteration; finding the rank for the record excluded
  double factor_seconds = 0.0;  ///< wall time of the pseudo-inverse or factor of W_bb
};

/// True when every row holds, slips or yields at both multipliers alike, and no bound follows
/// another multiplier: between them the problem is linear.
bool same_states(const Problem& problem, const VecX& a, const VecX& b);

/// ∂λ/∂g · dg at a solution [N]: rows that hold go on holding, those at their bounds stay there.
VecX response(const Problem& problem, const VecX& lambda, const VecX& dg);

/// max over rows of |δ_i| (bilateral) and W_ii |λ_i - clip(λ_i - δ_i / W_ii, ±F_i)| (box) [m]:
/// zero exactly at a solution. For bilateral and box rows (`solve` turns push rows into boxes). A
/// row that nothing can move, W_ii = 0, is off by |δ_i| where λ_i is not what that gap asks for.
double kkt_residual(const Problem& problem, const VecX& lambda);

}  // namespace trocar::law
