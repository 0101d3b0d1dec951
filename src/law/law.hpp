#pragma once

#include <cstdint>
#include <limits>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

/// Values of up to three rows, never on the heap.
using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using FewSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// The law of one to three rows: the convex set K that their multipliers may lie in [N]. Within K
/// the rows hold, δ = 0; on its border they give way outwards, -δ in the normal cone of K at λ.
/// Of a cone (λ_n, λ_t) the slip alone lies in the normal cone: δ_t opposes λ_t and δ_n = 0 while
/// the bodies touch (Coulomb); with De Saxcé's δ_n + μ|δ_t| it is the same statement for K.
struct Law
{
  enum class Set : std::uint8_t {
    zero,      ///< δ = 0, λ is free (K is the whole line)
    interval,  ///< lower <= λ <= upper: friction, or contact that yields at `upper`
    follower,  ///< |λ| <= friction · max(λ_leader, 0)
    disc,      ///< |λ| <= upper of two rows
    cone  ///< 0 <= λ_n <= upper, |λ_t| <= min(friction · λ_n, shear) of three rows (n, t1, t2)
  };
  Set set = Set::zero;
  double lower = 0.0, upper = std::numeric_limits<double>::infinity();  ///< [N]
  double friction = 0.0;                                                ///< coefficient
  double shear = std::numeric_limits<double>::infinity();               ///< a cone's cap [N]
  int leader = -1;  ///< row of the problem that a follower follows

  static Law zero() { return {}; }
  static Law interval(double lower, double upper) { return {Set::interval, lower, upper}; }
  static Law box(double bound) { return interval(-bound, bound); }
  static Law half_line() { return interval(0.0, std::numeric_limits<double>::infinity()); }
  static Law follower(int leader, double friction)
  {
    return {.set = Set::follower, .friction = friction, .leader = leader};
  }
  static Law disc(double radius) { return {Set::disc, 0.0, radius}; }
  /// Coulomb's cone, its normal force at most `upper`.
  static Law cone(double friction, double upper = std::numeric_limits<double>::infinity())
  {
    return {.set = Set::cone, .upper = upper, .friction = friction};
  }
  /// Its intersection with a disc: the shear force is at most `shear` (Tresca).
  static Law capped_cone(double friction, double shear)
  {
    return {.set = Set::cone, .friction = friction, .shear = shear};
  }

  int rows() const;
  bool operator==(const Law&) const = default;
};

/// The point of K next to x [N]. `leader` is the multiplier that a follower follows.
Few project(const Law& law, const Few& x, double leader = 0.0);

/// ∂ project / ∂x (rows x rows), symmetric, 0 <= D <= 1; where it jumps, that of one side.
FewSquare projection_derivative(const Law& law, const Few& x, double leader = 0.0);

/// What rows that nothing can move bear against their gap: the end of K opposite to it, of a cone
/// in the normal direction first [N]. Infinite where K is.
Few resisting(const Law& law, const Few& gap, double leader = 0.0);

/// How far (λ, δ) is from the law [m]: |λ - P_K(λ - δ/w)| w, zero exactly where it is met. `w` > 0
/// is the mean compliance of the rows [m/N].
double residual(const Law& law, const Few& lambda, const Few& delta, double w, double leader = 0.0);

}  // namespace trocar::law
