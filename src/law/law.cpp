#include "law/law.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::law {
namespace {

/// Limits of λ in a law of one row [N].
struct Ends
{
  double lower, upper;
};

Ends ends_of(const Law& law, double leader)
{
  if (law.set != Law::Set::follower) return {law.lower, law.upper};
  const double bound = law.friction * std::max(leader, 0.0);
  return {-bound, bound};
}

/// A point (n, s) = (λ_n, |λ_t|) of the half section of a cone [N]: 0 <= n <= upper, 0 <= s <=
/// min(μ n, shear). `along`: unit direction of the edge that the point lies on, zero at a corner.
struct Section
{
  double n, s;
  double along_n = 0.0, along_s = 0.0;
  bool inside = false;
};

Section nearest(const Law& law, double n, double s)
{
  const double mu = law.friction, square = 1.0 + mu * mu;
  const double top = std::min(mu * n, law.shear);
  if (n >= 0.0 && n <= law.upper && s <= top) {
    if (top > 0.0) return {n, s, 0.0, 0.0, true};
    return {n, s, n > 0.0 && n < law.upper ? 1.0 : 0.0, 0.0};
  }
  const double bend = mu > 0.0 ? std::min(law.upper, law.shear / mu) : law.upper;
  const double foot = std::clamp((n + mu * s) / square, 0.0, bend);
  Section best{foot, mu * foot};
  if (foot > 0.0 && foot < bend) {
    best.along_n = 1.0 / std::sqrt(square);
    best.along_s = mu / std::sqrt(square);
  }
  const auto distance = [&](const Section& at) { return std::hypot(at.n - n, at.s - s); };
  const auto better = [&](const Section& at) {
    if (distance(at) < distance(best)) best = at;
  };
  if (bend < law.upper) {
    const double on = std::clamp(n, bend, law.upper);
    better({on, law.shear, on > bend && on < law.upper ? 1.0 : 0.0, 0.0});
  }
  if (std::isfinite(law.upper)) {
    const double corner = std::min(mu * law.upper, law.shear);
    const double on = std::min(s, corner);
    better({law.upper, on, 0.0, s < corner ? 1.0 : 0.0});
  }
  return best;
}

/// Derivative of the map x -> radius x / |x|.
FewSquare drawn_derivative(const Few& x, double radius)
{
  const double length = x.norm();
  const Few e = x / length;
  return radius / length * (FewSquare::Identity(x.size(), x.size()) - e * e.transpose());
}

}  // namespace

int Law::rows() const
{
  if (set == Set::cone) return 3;
  return set == Set::disc ? 2 : 1;
}

Few project(const Law& law, const Few& x, double leader)
{
  Few on = x;
  if (law.set == Law::Set::interval || law.set == Law::Set::follower) {
    const Ends ends = ends_of(law, leader);
    on[0] = std::clamp(x[0], ends.lower, ends.upper);
  } else if (law.set == Law::Set::disc) {
    const double length = x.norm();
    if (length > law.upper) on *= law.upper / length;
  } else if (law.set == Law::Set::cone) {
    const double s = x.tail<2>().norm();
    const Section section = nearest(law, x[0], s);
    on[0] = section.n;
    if (s > 0.0) on.tail<2>() *= section.s / s;
  }
  return on;
}

FewSquare projection_derivative(const Law& law, const Few& x, double leader)
{
  FewSquare D = FewSquare::Identity(x.size(), x.size());
  if (law.set == Law::Set::interval || law.set == Law::Set::follower) {
    const Ends ends = ends_of(law, leader);
    D(0, 0) = x[0] > ends.lower && x[0] < ends.upper ? 1.0 : 0.0;
  } else if (law.set == Law::Set::disc && !(law.upper > 0.0)) {
    D.setZero();
  } else if (law.set == Law::Set::disc && x.norm() > law.upper) {
    D = drawn_derivative(x, law.upper);
  } else if (law.set == Law::Set::cone) {
    const Few t = x.tail<2>();
    const double s = t.norm();
    const Section at = nearest(law, x[0], s);
    if (at.inside) return D;
    D.setZero();
    D(0, 0) = at.along_n * at.along_n;
    if (s > 0.0) {
      const Few e = t / s;
      D.bottomRightCorner<2, 2>() =
          drawn_derivative(t, at.s) + at.along_s * at.along_s * e * e.transpose();
      D.bottomLeftCorner<2, 1>() = at.along_n * at.along_s * e;
      D.topRightCorner<1, 2>() = D.bottomLeftCorner<2, 1>().transpose();
    } else if (at.along_s == 1.0) {
      D.bottomRightCorner<2, 2>().setIdentity();
    }
  }
  return D;
}

Few resisting(const Law& law, const Few& gap, double leader)
{
  Few at = -gap;
  const auto drawn = [](const Few& t, double length) -> Few {
    const double size = t.norm();
    return size > 0.0 ? Few(t * (length / size)) : t;
  };
  if (law.set == Law::Set::zero) {
    at[0] = std::copysign(std::numeric_limits<double>::infinity(), at[0]);
  } else if (law.set == Law::Set::disc) {
    at = drawn(at, law.upper);
  } else if (law.set == Law::Set::cone) {
    at[0] = at[0] > 0.0 ? law.upper : 0.0;
    at.tail<2>() = drawn(at.tail<2>(), std::min(law.friction * at[0], law.shear));
  } else {
    const Ends ends = ends_of(law, leader);
    at[0] = at[0] > 0.0 ? ends.upper : ends.lower;
  }
  return at;
}

double residual(const Law& law, const Few& lambda, const Few& delta, double w, double leader)
{
  if (law.set == Law::Set::zero) return std::abs(delta[0]);
  Few meant = delta;
  // Slip must not open the gap, so μ|δ_t| is added to δ_n (De Saxcé and Feng 1998). At the cap
  // `shear` the limit does not depend on λ_n, and no term is needed.
  if (law.set == Law::Set::cone && law.friction * lambda[0] <= law.shear)
    meant[0] += law.friction * delta.tail<2>().norm();
  return w * (lambda - project(law, lambda - meant / w, leader)).norm();
}

}  // namespace trocar::law
