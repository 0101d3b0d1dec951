#pragma once

#include <string>
#include <vector>

#include "law/law.hpp"

namespace trocar::law {

/// Consecutive rows that share one law, and their coupling point.
struct Block
{
  int first = 0;
  Law law{};
  int point = 0;  ///< coupling point, ascending; Gauss-Seidel solves its blocks together

  int end() const { return first + law.rows(); }
};

/// The dense problem: δ = W λ + g, where (δ, λ) obeys the law of every block (needle paper, eq. 3).
/// If no set depends on a multiplier, this is the optimality system of min ½ λᵀWλ + gᵀλ over the
/// sets.
struct Problem
{
  MatX W;                     ///< compliance (rows x rows) [m/N], symmetric positive semidefinite
  VecX g;                     ///< gap after free motion (rows) [m]
  std::vector<Block> blocks;  ///< in the order of the rows; every row is in one block
  /// Compliance c of each row (rows; empty: all zero) [m/N]. A row of law `zero` with c > 0 obeys δ
  /// = -c λ: a linear dashpot or spring.
  VecX compliance;
  VecX start;  ///< multipliers to start from (rows) [N]

  Eigen::Index rows() const { return g.size(); }
};

enum class Method { automatic, pgs, hybrid, active_set, interior_point };

/// Stopping criterion of pgs and hybrid: the KKT residual, or the change of a sweep in the needle
/// paper's norm, Σ W_ii |Δλ_i| [m].
enum class Norm { residual, step };

struct Settings
{
  Method method = Method::automatic;
  Norm norm = Norm::residual;
  double tolerance = 1e-9;  ///< [m]
  int max_iterations = 1000;
};

/// The solution and its quality.
struct Multipliers
{
  VecX lambda;  ///< (rows) [N]
  VecX delta;   ///< W λ + g (rows) [m]
  bool converged = false;
  std::string why;         ///< when not converged: one line for the log
  int iterations = 0;      ///< sweeps or factorisations, those of a fallback included
  int outer = 1;           ///< solves with fixed sets until those that follow a multiplier settled
  double contraction = 0;  ///< ratio of the last two changes of these sets, < 1 when they settle
  double residual = 0.0;   ///< KKT residual [m], see `kkt_residual`
  int rank = 0;            ///< numerical rank of W
  double condition = 0.0;  ///< lower bound, of W_bb without redundant rows (0: none found)
  bool nonunique = false;  ///< single λ_i are not unique; δ, nodal forces and work are
  int immovable = -1;      ///< row that nothing can move and whose gap violates its law; -1: none
  double seconds = 0.0;    ///< wall time of the iteration, without finding the rank [s]
  double factor_seconds = 0.0;  ///< wall time of the pseudo-inverse or factor of W_bb [s]
};

/// True when every row is in the same state (holds, slips, yields or is apart) at the multipliers a
/// and b, and the problem is linear between a and b: it has no follower with friction, and no pair
/// of rows slips, because its direction of slip could turn. `tolerance`: residual to which the laws
/// hold [m].
bool same_states(const Problem& problem, const VecX& a, const VecX& b, double tolerance);

/// ∂λ/∂g · dg at a solution [N]. Rows that hold go on holding; multipliers on their limits stay
/// there. `tolerance`: residual to which the laws hold [m].
VecX response(const Problem& problem, const VecX& lambda, const VecX& dg, double tolerance);

/// Largest residual of a block's law [m], zero exactly at a solution; NaN when δ is not finite. The
/// residual of a block that nothing can move (W_ii = 0) is its gap, or zero if its multipliers are
/// those of `resisting`.
double kkt_residual(const Problem& problem, const VecX& lambda);

}  // namespace trocar::law
