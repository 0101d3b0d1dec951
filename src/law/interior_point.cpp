#include <algorithm>
#include <cmath>

#include "core/dense.hpp"
#include "law/box_qp.hpp"

namespace trocar::law {
namespace {

/// Point and direction: x, distances to the bounds u = x + F and v = F - x, their multipliers.
struct Point
{
  VecX x, u, v, y, z;
};

double longest_step(const VecX& value, const VecX& change, double longest)
{
  for (Eigen::Index i = 0; i < value.size(); ++i)
    if (change[i] < 0.0) longest = std::min(longest, -0.995 * value[i] / change[i]);
  return longest;
}

double longest_step(const Point& p, const Point& d)
{
  double step = longest_step(p.u, d.u, 1.0);
  step = longest_step(p.v, d.v, step);
  step = longest_step(p.y, d.y, step);
  return longest_step(p.z, d.z, step);
}

double complementarity(const Point& p)
{
  return (p.u.dot(p.y) + p.v.dot(p.z)) / (2.0 * static_cast<double>(p.x.size()));
}

/// Newton direction towards u∘y = target_u, v∘z = target_v; `dual` = S x + s - y + z.
Point direction(const core::Cholesky& factor, const Point& p, const VecX& dual,
                const VecX& target_u, const VecX& target_v)
{
  Point d;
  const VecX to_y = target_u.cwiseQuotient(p.u) - p.y;
  const VecX to_z = target_v.cwiseQuotient(p.v) - p.z;
  d.x = factor.solve(VecX(-dual + to_y - to_z));
  d.u = d.x;
  d.v = -d.x;
  d.y = to_y - p.y.cwiseQuotient(p.u).cwiseProduct(d.x);
  d.z = to_z + p.z.cwiseQuotient(p.v).cwiseProduct(d.x);
  return d;
}

void move(Point& p, const Point& d, double step)
{
  p.x += step * d.x;
  p.u += step * d.u;
  p.v += step * d.v;
  p.y += step * d.y;
  p.z += step * d.z;
}

/// S with the curvature of both barriers.
MatX barrier(const MatX& S, const Point& p)
{
  MatX shifted = S;
  shifted.diagonal() += p.y.cwiseQuotient(p.u) + p.z.cwiseQuotient(p.v);
  return shifted;
}

/// What the products of a trial point lack to be neither much smaller nor much larger than they
/// should be; never much less than that, or the largest of them would rule the direction.
VecX short_of(const VecX& products, double centre)
{
  constexpr double smallest = 0.1, largest = 10.0;
  const VecX meant = products.cwiseMax(smallest * centre).cwiseMin(largest * centre);
  return (meant - products).cwiseMax(-largest * centre);
}

/// Mehrotra: how far the affine step gets says how much to centre, and what it leaves is corrected.
/// Gondzio (1996): with the same factor it is then corrected again for products that run away over
/// a longer step, as long as that lengthens it.
Point corrected_direction(const core::Cholesky& factor, const Point& p, const VecX& dual)
{
  constexpr int most = 3;
  constexpr double reach = 0.3, gain = 0.03;  // of a step more, tried and asked for
  const VecX zero = VecX::Zero(p.x.size());
  const Point affine = direction(factor, p, dual, zero, zero);
  Point trial = p;
  move(trial, affine, longest_step(p, affine));
  const double mu = complementarity(p);
  const double centre = mu * std::pow(complementarity(trial) / mu, 3);
  VecX target_u = centre - affine.x.cwiseProduct(affine.y).array();
  VecX target_v = centre + affine.x.cwiseProduct(affine.z).array();
  Point best = direction(factor, p, dual, target_u, target_v);
  double step = longest_step(p, best);
  for (int k = 0; k < most && step < 0.9; ++k) {
    trial = p;
    move(trial, best, std::min(step + reach, 1.0));
    target_u += short_of(trial.u.cwiseProduct(trial.y), centre);
    target_v += short_of(trial.v.cwiseProduct(trial.z), centre);
    const Point next = direction(factor, p, dual, target_u, target_v);
    const double longer = longest_step(p, next);
    if (longer < step + gain) break;
    best = next;
    step = longer;
  }
  return best;
}

/// Moves as far as keeps every product from running ahead of the others: without this the step
/// may cycle between two corners.
void move_centred(Point& p, const Point& d)
{
  constexpr double neighbourhood = 1e-3;
  double step = longest_step(p, d);
  for (int cut = 0; cut < 20; ++cut, step *= 0.7) {
    Point trial = p;
    move(trial, d, step);
    const double least = std::min(trial.u.cwiseProduct(trial.y).minCoeff(),
                                  trial.v.cwiseProduct(trial.z).minCoeff());
    if (least < neighbourhood * complementarity(trial) && cut < 19) continue;
    p = trial;
    return;
  }
}

/// x with the rows that tend to a bound put on it: whether a row slips is then no matter of degree.
VecX on_bounds(const Point& p, const VecX& F)
{
  VecX x = p.x.cwiseMax(-F).cwiseMin(F);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (p.u[i] < p.y[i]) x[i] = -F[i];
    if (p.v[i] < p.z[i]) x[i] = F[i];
  }
  return x;
}

/// The start drawn a little into the box, with the multipliers its gradient asks for.
Point warm_point(const MatX& S, const VecX& s, const VecX& F, const VecX& start)
{
  constexpr double inwards = 0.1;  // of F, and of the mean gradient
  const VecX x = start.cwiseMax((inwards - 1.0) * F).cwiseMin((1.0 - inwards) * F);
  const VecX gradient = S * x + s;
  const double least = inwards * gradient.cwiseAbs().mean() + 1e-12;
  return {x, x + F, F - x, gradient.cwiseMax(0.0).array() + least,
          (-gradient).cwiseMax(0.0).array() + least};
}

}  // namespace

double box_residual(const MatX& S, const VecX& s, const VecX& F, const VecX& x)
{
  const VecX gradient = S * x + s;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double w = std::max(S(i, i), 1e-300);
    const double natural = x[i] - std::clamp(x[i] - gradient[i] / w, -F[i], F[i]);
    if (std::isnan(natural)) return natural;
    worst = std::max(worst, w * std::abs(natural));
  }
  return worst;
}

BoxSolution interior_point(const MatX& S_in, const VecX& s_in, const VecX& F_in, const VecX& start,
                           double tolerance, int max_iterations)
{
  const double force = std::max(F_in.maxCoeff(), 1e-300);
  const double gap = s_in.cwiseAbs().maxCoeff() + (S_in * F_in).cwiseAbs().maxCoeff() + 1e-300;
  const VecX F = F_in.cwiseMax(1e-14 * force) / force;
  const MatX S = S_in * (force / gap);
  const VecX s = s_in / gap;
  Point p = warm_point(S, s, F, start / force);
  BoxSolution result;
  for (int k = 0; k < max_iterations; ++k) {
    const VecX dual = S * p.x + s - p.y + p.z;
    result.finished = gap * box_residual(S, s, F, on_bounds(p, F)) <= tolerance;
    if (result.finished) break;
    const core::Cholesky factor(barrier(S, p));
    ++result.factorisations;
    if (!factor.regular()) break;
    const Point d = corrected_direction(factor, p, dual);
    move_centred(p, d);
  }
  result.x = on_bounds(p, F) * force;
  return result;
}

}  // namespace trocar::law
