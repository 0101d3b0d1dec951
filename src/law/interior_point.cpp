#include <algorithm>
#include <cmath>

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
Point direction(const Eigen::LLT<MatX>& factor, const Point& p, const VecX& dual,
                const VecX& target_u, const VecX& target_v)
{
  Point d;
  const VecX to_y = target_u.cwiseQuotient(p.u) - p.y;
  const VecX to_z = target_v.cwiseQuotient(p.v) - p.z;
  d.x = factor.solve(-dual + to_y - to_z);
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

}  // namespace

BoxSolution interior_point(const MatX& S_in, const VecX& s_in, const VecX& F_in, double tolerance,
                           int max_iterations)
{
  const Eigen::Index n = s_in.size();
  const double force = std::max(F_in.maxCoeff(), 1e-300);
  const double gap = s_in.cwiseAbs().maxCoeff() + (S_in * F_in).cwiseAbs().maxCoeff() + 1e-300;
  const VecX F = F_in.cwiseMax(1e-14 * force) / force;
  const MatX S = S_in * (force / gap);
  const VecX s = s_in / gap;
  Point p{VecX::Zero(n), F, F, VecX::Ones(n), VecX::Ones(n)};
  BoxSolution result;
  for (int k = 0; k < max_iterations; ++k) {
    const VecX dual = S * p.x + s - p.y + p.z;
    const double mu = complementarity(p);
    if (std::max(dual.cwiseAbs().maxCoeff(), mu) < tolerance) {
      result.finished = true;
      break;
    }
    MatX shifted = S;
    shifted.diagonal() += p.y.cwiseQuotient(p.u) + p.z.cwiseQuotient(p.v);
    const Eigen::LLT<MatX> factor(shifted);
    ++result.factorisations;
    if (factor.info() != Eigen::Success) break;
    const Point affine = direction(factor, p, dual, VecX::Zero(n), VecX::Zero(n));
    Point trial = p;
    move(trial, affine, longest_step(p, affine));
    const double sigma = std::pow(complementarity(trial) / mu, 3);
    const VecX corrector = affine.x.cwiseProduct(affine.y);
    const VecX corrector_z = affine.x.cwiseProduct(affine.z);
    const Point d = direction(factor, p, dual, VecX::Constant(n, sigma * mu) - corrector,
                              VecX::Constant(n, sigma * mu) + corrector_z);
    move(p, d, longest_step(p, d));
  }
  result.x = (p.x * force).cwiseMax(-F_in).cwiseMin(F_in);
  return result;
}

}  // namespace trocar::law
