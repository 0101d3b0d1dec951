#pragma once

#include <string>
#include <vector>

#include "law/law.hpp"

namespace trocar::law {

/// Rows that share a law, and the coupling point they belong to.
struct Block
{
  int first = 0;
  Law law{};
  int point = 0;  ///< ascending: Gauss-Seidel solves the blocks of a point together

  int end() const { return first + law.rows(); }
};

/// The dense problem  δ = W λ + g, (δ, λ) in every block's law  (needle paper, eq. 3).
/// With sets of fixed size it is the optimality system of min ½ λᵀWλ + gᵀλ over them.
struct Problem
{
  MatX W;                     ///< compliance (rows x rows) [m/N], symmetric positive semidefinite
  VecX g;                     ///< violation after free motion (rows) [m]
  std::vector<Block> blocks;  ///< in order, of all rows
  /// Compliant rows: one of the law `zero` with compliance c obeys δ = -c λ, a linear dashpot or
  /// spring (rows, or empty: all hard) [m/N].
  VecX compliance;
  VecX start;  ///< multipliers to start from (rows) [N]

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

/// True when every row holds, slips or yields at both multipliers alike, and between them the
/// problem is linear: no set follows a multiplier, and no slip turns. `tolerance`: to which the
/// laws were met [m].
bool same_states(const Problem& problem, const VecX& a, const VecX& b, double tolerance);

/// ∂λ/∂g · dg at a solution [N]: rows that hold go on holding, those at their bounds stay there.
VecX response(const Problem& problem, const VecX& lambda, const VecX& dg, double tolerance);

/// Largest residual of a block in its law [m], zero exactly at a solution. A block that nothing can
/// move, W_ii = 0, is off by its gap where its multipliers are not what that gap asks for.
double kkt_residual(const Problem& problem, const VecX& lambda);

}  // namespace trocar::law
