#include <algorithm>
#include <cmath>
#include <vector>

#include "core/dense.hpp"
#include "law/inequalities.hpp"

namespace trocar::law {
namespace {

/// A point of the iteration, or a direction: x, the values c of the single rows' inequalities and
/// their multipliers z, and the multipliers of the cones.
struct Point
{
  VecX x, c, z;
  std::vector<Vec3> cones;
};

/// Values that a step aims at for the products c∘z, of single rows and of cones.
struct Target
{
  VecX single;
  std::vector<Vec3> cones;
};

/// Newton directions at one point; all of them use one factor.
class Newton
{
 public:
  Newton(const Inequalities& in, const BoxQp& qp, const Point& at) : in_(in), at_(at)
  {
    for (std::size_t k = 0; k < in.pairs(); ++k)
      scaling_.emplace_back(in.cone(k, at.x), at.cones[k]);
    dual_ = -qp.gradient(at.x);
    in.add_pull(at.z, at.cones, dual_);
    factor_.compute(in.barrier(qp.S, at.z.cwiseQuotient(at.c), scaling_));
  }
  bool regular() const { return factor_.regular(); }
  const cone::Scaling& scaling(std::size_t k) const { return scaling_[k]; }

  Point towards(const Target& target) const
  {
    Point d;
    const VecX to_z = target.single.cwiseQuotient(at_.c) - at_.z;
    std::vector<Vec3> to_cones;
    for (std::size_t k = 0; k < in_.pairs(); ++k) {
      const Vec3& lambda = scaling_[k].lambda;
      to_cones.push_back(scaling_[k].inverse * (cone::divided(target.cones[k], lambda) - lambda));
    }
    VecX rhs = dual_;
    in_.add_pull(to_z, to_cones, rhs);
    d.x = factor_.solve(rhs);
    d.c = in_.change(d.x);
    d.z = to_z - at_.z.cwiseQuotient(at_.c).cwiseProduct(d.c);
    for (std::size_t k = 0; k < in_.pairs(); ++k) {
      const Vec3 du = in_.cone_change(k, d.x);
      d.cones.push_back(to_cones[k] - scaling_[k].inverse * (scaling_[k].inverse * du));
    }
    return d;
  }

 private:
  const Inequalities& in_;
  const Point& at_;
  std::vector<cone::Scaling> scaling_;
  VecX dual_;  ///< -(S x + s - Jᵀz), J the Jacobian of the inequalities
  core::Cholesky factor_;
};

double longest_step(const VecX& value, const VecX& change, double longest)
{
  for (Eigen::Index i = 0; i < value.size(); ++i)
    if (change[i] < 0.0) longest = std::min(longest, -0.995 * value[i] / change[i]);
  return longest;
}

double longest_step(const Inequalities& in, const Point& p, const Point& d)
{
  double step = longest_step(p.z, d.z, longest_step(p.c, d.c, 1.0));
  for (std::size_t k = 0; k < in.pairs(); ++k) {
    const Vec3 du = in.cone_change(k, d.x);
    step = std::min(step, 0.995 * cone::step_to_border(in.cone(k, p.x), du));
    step = std::min(step, 0.995 * cone::step_to_border(p.cones[k], d.cones[k]));
  }
  return step;
}

double complementarity(const Inequalities& in, const Point& p)
{
  double sum = p.c.dot(p.z);
  for (std::size_t k = 0; k < in.pairs(); ++k) sum += in.cone(k, p.x).dot(p.cones[k]);
  return sum / static_cast<double>(p.c.size() + static_cast<Eigen::Index>(in.pairs()));
}

/// Smallest complementarity product: c z of a single row's inequality, or root(u) root(z) of a cone
/// u with its multiplier z.
double least_product(const Inequalities& in, const Point& p)
{
  double least = p.c.size() > 0 ? p.c.cwiseProduct(p.z).minCoeff() : 1e300;
  for (std::size_t k = 0; k < in.pairs(); ++k)
    least = std::min(least, cone::root(in.cone(k, p.x)) * cone::root(p.cones[k]));
  return least;
}

void move(Point& p, const Point& d, double step)
{
  p.x += step * d.x;
  p.c += step * d.c;
  p.z += step * d.z;
  for (std::size_t k = 0; k < p.cones.size(); ++k) p.cones[k] += step * d.cones[k];
}

/// Gondzio's correction: the changes that bring the products of a trial point between 0.1 and 10
/// times `centre`. No change is below -10 centre; otherwise the largest product would dominate the
/// direction.
VecX short_of(const VecX& products, double centre)
{
  constexpr double smallest = 0.1, largest = 10.0;
  const VecX meant = products.cwiseMax(smallest * centre).cwiseMin(largest * centre);
  return (meant - products).cwiseMax(-largest * centre);
}

/// Mehrotra's direction: the length of the affine step decides how much to centre, and the
/// second-order error of the affine step is corrected. Gondzio's corrections (1996) follow with the
/// same factor. They bring back products of single rows that a longer step would make much larger
/// or smaller than the others. A correction is kept if it makes the step longer.
Point corrected_direction(const Inequalities& in, const Newton& newton, const Point& p)
{
  constexpr int most = 3;
  constexpr double reach = 0.3, gain = 0.03;  // increase of the step: tried, required
  Target target{VecX::Zero(p.c.size()), std::vector<Vec3>(in.pairs(), Vec3::Zero())};
  const Point affine = newton.towards(target);
  Point trial = p;
  move(trial, affine, longest_step(in, p, affine));
  const double mu = complementarity(in, p);
  const double centre = mu * std::pow(complementarity(in, trial) / mu, 3);
  target.single = centre - affine.c.cwiseProduct(affine.z).array();
  for (std::size_t k = 0; k < in.pairs(); ++k) {
    const cone::Scaling& scaling = newton.scaling(k);
    const Vec3 du = scaling.inverse * in.cone_change(k, affine.x);
    const Vec3 dz = scaling.W * affine.cones[k];
    target.cones[k] = Vec3(centre, 0.0, 0.0) - cone::product(du, dz);
  }
  Point best = newton.towards(target);
  double step = longest_step(in, p, best);
  for (int k = 0; k < most && step < 0.9 && in.singles() > 0; ++k) {
    trial = p;
    move(trial, best, std::min(step + reach, 1.0));
    target.single += short_of(trial.c.cwiseProduct(trial.z), centre);
    const Point next = newton.towards(target);
    const double longer = longest_step(in, p, next);
    if (longer < step + gain) break;
    best = next;
    step = longer;
  }
  return best;
}

/// Moves along d. The step is cut until no product is below 1e-3 of the mean product: without this
/// limit the iteration may cycle between two corners.
void move_centred(const Inequalities& in, Point& p, const Point& d)
{
  constexpr double neighbourhood = 1e-3;
  double step = longest_step(in, p, d);
  for (int cut = 0; cut < 20; ++cut, step *= 0.7) {
    Point trial = p;
    move(trial, d, step);
    const double least = least_product(in, trial);
    if (least < neighbourhood * complementarity(in, trial) && cut < 19) continue;
    p = trial;
    return;
  }
}

/// First point: `start` moved to the inside of the bounds, and multipliers from the gradient there.
Point warm_point(const Inequalities& in, const BoxQp& qp, const VecX& start)
{
  const Bounds& bounds = qp.bounds;
  // Least distance from a bound, in units of F; least multiplier, in units of the mean |gradient|.
  constexpr double inwards = 0.1;
  Point p{Bounds{(1.0 - inwards) * bounds.F, bounds.pairs}.clip(start), {}, {}, {}};
  p.c = in.values(p.x);
  const VecX gradient = qp.gradient(p.x);
  const double least = inwards * gradient.cwiseAbs().mean() + 1e-12;
  // The slopes of c are ±1. A multiplier is therefore the positive part of ± the gradient.
  p.z = in.change(gradient).cwiseMax(0.0).array() + least;
  for (int i : bounds.pairs) {
    const Eigen::Vector2d pull = gradient.segment<2>(i);
    p.cones.push_back({(1.0 + inwards) * pull.norm() + least, pull.x(), pull.y()});
  }
  return p;
}

}  // namespace

BoxSolution interior_point(const BoxQp& qp, const VecX& start, double tolerance, int max_iterations)
{
  const VecX& F_in = qp.bounds.F;
  const double force = std::max(F_in.maxCoeff(), 1e-300);
  const double gap = qp.s.cwiseAbs().maxCoeff() + (qp.S * F_in).cwiseAbs().maxCoeff() + 1e-300;
  const Bounds bounds{F_in.cwiseMax(1e-14 * force) / force, qp.bounds.pairs};
  const Inequalities in(bounds);
  const MatX S = qp.S * (force / gap);
  const VecX s = qp.s / gap;
  const BoxQp scaled{S, s, bounds};
  Point p = warm_point(in, scaled, start / force);
  BoxSolution result;
  for (int k = 0; k < max_iterations; ++k) {
    const VecX on = in.on_bounds(p.x, p.c, p.z, p.cones);
    result.finished = gap * box_residual(scaled, on) <= tolerance;
    if (result.finished) break;
    const Newton newton(in, scaled, p);
    ++result.factorisations;
    if (!newton.regular()) break;
    const Point d = corrected_direction(in, newton, p);
    if (!d.x.allFinite()) break;
    move_centred(in, p, d);
  }
  result.x = in.on_bounds(p.x, p.c, p.z, p.cones) * force;
  return result;
}

}  // namespace trocar::law
