#pragma once

#include <cstdint>
#include <limits>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

/// Vector and matrix for the rows of one block (at most three); they never use the heap.
using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using FewSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// The law of a block of one to three rows: the convex set K that their multipliers must lie in
/// [N]. Where λ is inside K, the rows hold: δ = 0. Where λ is on the border of K, the rows may give
/// way: -δ lies in the normal cone of K at λ.
/// Coulomb's cone is the exception: while the bodies touch, δ_n = 0, and only the slip δ_t is
/// normal to the border, opposite to λ_t. With δ_n + μ|δ_t| in place of δ_n the normal-cone
/// condition holds for this K too (De Saxcé and Feng 1998).
struct Law
{
  enum class Set : std::uint8_t {
    zero,      ///< δ = 0, λ is free (K is the whole line)
    interval,  ///< lower <= λ <= upper: friction, or contact that yields at `upper`
    follower,  ///< |λ| <= friction · max(λ_leader, 0)
    disc,      ///< |λ| <= upper, two rows
    cone  ///< 0 <= λ_n <= upper, |λ_t| <= min(friction · λ_n, shear), three rows (n, t1, t2)
  };
  Set set = Set::zero;
  /// Limits of λ, see `Set` [N].
  double lower = 0.0, upper = std::numeric_limits<double>::infinity();
  double friction = 0.0;                                   ///< coefficient of friction
  double shear = std::numeric_limits<double>::infinity();  ///< limit of |λ_t| of a cone [N]
  int leader = -1;  ///< of a follower: row of the problem whose multiplier is λ_leader

  static Law zero() { return {}; }
  static Law interval(double lower, double upper) { return {Set::interval, lower, upper}; }
  static Law box(double bound) { return interval(-bound, bound); }
  static Law half_line() { return interval(0.0, std::numeric_limits<double>::infinity()); }
  static Law follower(int leader, double friction)
  {
    return {.set = Set::follower, .friction = friction, .leader = leader};
  }
  static Law disc(double radius) { return {Set::disc, 0.0, radius}; }
  /// Coulomb's cone; the normal force is at most `upper` [N].
  static Law cone(double friction, double upper = std::numeric_limits<double>::infinity())
  {
    return {.set = Set::cone, .upper = upper, .friction = friction};
  }
  /// Coulomb's cone with a shear force of at most `shear` [N] (Tresca).
  static Law capped_cone(double friction, double shear)
  {
    return {.set = Set::cone, .friction = friction, .shear = shear};
  }

  int rows() const;
  /// A cone, or an interval without an upper end: bodies that touch, or are apart.
  bool one_sided() const
  {
    const bool half = set == Set::interval && upper == std::numeric_limits<double>::infinity();
    return set == Set::cone || half;
  }
  bool operator==(const Law&) const = default;
};

/// The point of K nearest to x [N]. `leader`: λ_leader of a follower [N].
Few project(const Law& law, const Few& x, double leader = 0.0);

/// ∂ project / ∂x (rows x rows): symmetric, with eigenvalues between 0 and 1. Where the derivative
/// is discontinuous, the result is its value on one side.
FewSquare projection_derivative(const Law& law, const Few& x, double leader = 0.0);

/// Multipliers of rows that nothing can move (W_ii = 0): the end of K that pushes against their gap
/// [N]. For a cone, λ_n is chosen first and λ_t within its limit. Infinite where K has no end.
Few resisting(const Law& law, const Few& gap, double leader = 0.0);

/// Residual of the law [m]: |λ - P_K(λ - δ/w)| w with P_K = `project`. It is zero exactly where (λ,
/// δ) obeys the law. `w` > 0: mean compliance of the rows [m/N].
double residual(const Law& law, const Few& lambda, const Few& delta, double w, double leader = 0.0);

}  // namespace trocar::law
