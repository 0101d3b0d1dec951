#include "law/cone_newton.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"
#include "core/stopwatch.hpp"
#include "law/immovable.hpp"
#include "law/pivoted_cholesky.hpp"

namespace trocar::law {
namespace {

/// Newton's equations at a point: J Δλ = -F, with F in metres for rows that hold and in newtons
/// times the block's mobility for the others.
class Equations
{
 public:
  Equations(const Problem& problem, const VecX& lambda, const VecX& give)
      : problem_(problem),
        lambda_(lambda),
        delta_(problem.W * lambda + problem.g),
        J_(MatX::Zero(problem.rows(), problem.rows())),
        F_(problem.rows())
  {
    for (const Block& block : problem.blocks) {
      const double w = give.segment(block.first, block.law.rows()).mean();
      if (!(w > 0.0))
        keep(block);
      else if (block.law.set == Law::Set::cone)
        cone(block, w);
      else
        single(block, w);
    }
  }
  VecX step() const { return core::Square(J_).solve(-F_); }

 private:
  /// Row i holds: δ_i + c λ_i = 0. A little compliance keeps redundant rows from contradicting.
  void hold(int i, double w)
  {
    constexpr double proximal = 1e-11;
    J_.row(i) = problem_.W.row(i);
    const double c = problem_.compliance.size() > 0 ? problem_.compliance[i] : 0.0;
    J_(i, i) += c + proximal * w;
    F_[i] = delta_[i] + c * lambda_[i];
  }
  /// λ_i takes a value.
  void take(int i, double value, double w)
  {
    J_(i, i) = w;
    F_[i] = w * (lambda_[i] - value);
  }
  /// Rows that nothing can move keep their multipliers.
  void keep(const Block& block)
  {
    for (int i = block.first; i < block.end(); ++i) take(i, lambda_[i], 1.0);
  }
  void single(const Block& block, double w)
  {
    const int i = block.first;
    const double trial = lambda_[i] - delta_[i] / w;
    if (block.law.set == Law::Set::zero)
      hold(i, w);
    else if (trial < block.law.lower)
      take(i, block.law.lower, w);
    else if (trial > block.law.upper)
      take(i, block.law.upper, w);
    else
      hold(i, w);
  }
  void cone(const Block& block, double w)
  {
    const int n = block.first;
    const Law& law = block.law;
    const double normal = lambda_[n] - delta_[n] / w;
    if (!(normal > 0.0)) {
      for (int i = n; i < block.end(); ++i) take(i, 0.0, w);
      return;
    }
    const bool yields = normal > law.upper;
    if (yields)
      take(n, law.upper, w);
    else
      hold(n, w);
    const Eigen::Vector2d trial = lambda_.segment<2>(n + 1) - delta_.segment<2>(n + 1) / w;
    const double pushed = law.friction * std::min(normal, law.upper);
    const double bound = std::min(pushed, law.shear), size = trial.norm();
    if (size <= bound) {
      hold(n + 1, w);
      hold(n + 2, w);
      return;
    }
    slip(n, w, trial / size, bound / size);
    const Eigen::Vector2d limit = bound / size * trial;
    F_.segment<2>(n + 1) = w * (lambda_.segment<2>(n + 1) - limit);
    if (pushed > law.shear || yields) return;
    // The bound follows the normal trial force.
    const Eigen::RowVectorXd normal_change = unit(n) - problem_.W.row(n) / w;
    for (int k = 0; k < 2; ++k)
      J_.row(n + 1 + k) -= w * law.friction * (trial / size)[k] * normal_change;
  }
  /// Tangential rows of a slipping group, for a fixed bound: `part` = bound / |trial|.
  void slip(int n, double w, const Eigen::Vector2d& e, double part)
  {
    const Eigen::Matrix2d turn = part * (Eigen::Matrix2d::Identity() - e * e.transpose());
    for (int k = 0; k < 2; ++k) {
      J_.row(n + 1 + k) = w * unit(n + 1 + k);
      for (int l = 0; l < 2; ++l)
        J_.row(n + 1 + k) -= w * turn(k, l) * (unit(n + 1 + l) - problem_.W.row(n + 1 + l) / w);
    }
  }
  Eigen::RowVectorXd unit(int i) const { return Eigen::RowVectorXd::Unit(problem_.rows(), i); }

  const Problem& problem_;
  const VecX& lambda_;
  VecX delta_;
  MatX J_;
  VecX F_;
};

/// Open groups get multipliers of exactly zero: what the linear solve leaves there is rounding, and
/// would count as touching.
void open_exactly(const Problem& problem, const VecX& give, double tolerance, VecX& lambda)
{
  if (lambda.size() == 0) return;
  VecX clean = lambda;
  const VecX delta = problem.W * lambda + problem.g;
  for (const Block& block : problem.blocks) {
    const int n = block.first;
    if (block.law.one_sided() && give[n] > 0.0 && lambda[n] - delta[n] / give[n] <= block.law.lower)
      clean.segment(n, block.law.rows()).setConstant(block.law.lower);
  }
  if (kkt_residual(problem, clean) <= tolerance) lambda = clean;
}

void describe(const Problem& problem, Multipliers& result)
{
  const PivotedCholesky factor(problem.W);
  result.rank = factor.rank();
  result.condition = factor.condition();
  result.nonunique = factor.rank() < problem.rows();
}

}  // namespace

bool all_for_cone_newton(const Problem& problem)
{
  bool any = false;
  for (const Block& block : problem.blocks) {
    any = any || block.law.one_sided();
    if (block.law.set == Law::Set::follower || block.law.set == Law::Set::disc) return false;
  }
  return any;
}

Multipliers cone_newton(const Problem& problem, const Settings& settings, int most)
{
  const core::Stopwatch watch;
  Multipliers result;
  const VecX give = mobility(problem);
  VecX lambda = problem.start.size() == problem.rows() ? problem.start : VecX::Zero(problem.rows());
  // It goes on below the tolerance while a step helps: in a stiff body 1e-9 m are no small force.
  // Without a smaller residual it goes in a circle, or has come to rounding.
  constexpr int most_idle = 8;
  constexpr double tight = 1e-9;  // part of the displacements that the forces make on their own
  double best = std::numeric_limits<double>::infinity();
  int idle = 0;
  for (int k = 0; k <= most; ++k) {
    const double residual = kkt_residual(problem, lambda);
    if (!std::isfinite(residual)) break;
    idle = residual < best ? 0 : idle + 1;
    if (residual < best) {
      best = residual;
      result.lambda = lambda;
    }
    const bool within = best <= settings.tolerance;
    const double moved = result.lambda.cwiseProduct(give).cwiseAbs().maxCoeff();
    if (within && best <= tight * moved) break;
    if (idle > most_idle || k == most) break;
    lambda += Equations(problem, lambda, give).step();
    ++result.iterations;
  }
  open_exactly(problem, give, settings.tolerance, result.lambda);
  best = result.lambda.size() > 0 ? kkt_residual(problem, result.lambda) : best;
  result.residual = best;
  result.converged = best <= settings.tolerance;
  if (result.converged) {
    result.delta = problem.W * result.lambda + problem.g;
    describe(problem, result);
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace trocar::law
