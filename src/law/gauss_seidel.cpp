#include "law/gauss_seidel.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/dense.hpp"
#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "law/schur_complement.hpp"

namespace trocar::law {
namespace {

/// The rows first .. end-1 of one coupling point. `boxes` and `discs` are rows counted from
/// `first`; a disc is given by its first row.
struct Group
{
  Eigen::Index first, end;
  std::vector<int> boxes, discs;
};

std::vector<Group> groups_of(const Problem& problem)
{
  std::vector<Group> groups;
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    if (b == 0 || block.point != problem.blocks[b - 1].point)
      groups.push_back({block.first, block.first, {}, {}});
    Group& group = groups.back();
    const auto row = block.first - static_cast<int>(group.first);
    if (block.law.set == Law::Set::interval) group.boxes.push_back(row);
    if (block.law.set == Law::Set::disc) group.discs.push_back(row);
    group.end = block.end();
  }
  return groups;
}

/// Projected gradient step for the two multipliers of a disc. `w`: trace of their block of W [m/N],
/// at least its largest eigenvalue, so that the step cannot overshoot.
Eigen::Vector2d on_disc(const Eigen::Vector2d& lambda, const Eigen::Vector2d& delta, double w,
                        double radius)
{
  if (!(w > 0.0)) return lambda;
  return project(Law::disc(radius), Few(lambda - delta / w));
}

/// Multipliers of one group that satisfy its laws, with all other rows fixed [N]. `residual`: δ of
/// the group [m]; `F`: its bounds [N]. First all rows except discs are solved as bilateral rows.
/// Then each box row outside its box is put on its bound, and the rest is solved again. Last, each
/// disc takes one gradient step.
VecX solve_group(const Problem& problem, const Group& group, const VecX& F, const VecX& lambda,
                 const VecX& residual)
{
  const Eigen::Index n = group.end - group.first;
  const MatX W = problem.W.block(group.first, group.first, n, n);
  const VecX held = residual - W * lambda;  // δ of the group at λ_group = 0
  std::vector<int> free;
  VecX next = VecX::Zero(n);
  for (int i = 0; i < n; ++i)
    if (W(i, i) > 0.0) free.push_back(i);
  for (int disc : group.discs) {
    std::erase_if(free, [disc](int i) { return i == disc || i == disc + 1; });
    next.segment<2>(disc) = lambda.segment<2>(disc);
  }
  const auto solve_free = [&] {
    if (free.empty()) return;
    next(free).setZero();
    const VecX rhs = -(held + W * next)(free);
    next(free) = core::least_squares(W(free, free), rhs);
  };
  solve_free();
  for (int i : group.boxes) {
    if (std::abs(next[i]) <= F[i]) continue;
    next[i] = std::clamp(next[i], -F[i], F[i]);
    std::erase(free, i);
    solve_free();
  }
  for (int disc : group.discs) {
    const Eigen::Vector2d delta = (held + W * next).segment<2>(disc);
    const double w = W(disc, disc) + W(disc + 1, disc + 1);
    next.segment<2>(disc) = on_disc(next.segment<2>(disc), delta, w, F[disc]);
  }
  return next;
}

/// Bounds of all rows [N]; infinite on those of the law zero.
VecX bounds_of(const Problem& problem)
{
  VecX F(problem.rows());
  for (const Block& block : problem.blocks)
    F.segment(block.first, block.law.rows()).setConstant(block.law.upper);
  return F;
}

bool stop(const Problem& problem, const Settings& settings, double step, Multipliers& result)
{
  if (settings.norm == Norm::step) return step < settings.tolerance;
  result.residual = kkt_residual(problem, result.lambda);
  return result.residual <= settings.tolerance;
}

void finish(const Problem& problem, const Settings& settings, const char* name, Multipliers& result)
{
  result.residual = kkt_residual(problem, result.lambda);
  result.rank = PivotedCholesky(problem.W).rank();
  result.nonunique = result.rank < problem.rows();
  if (!result.converged)
    result.why = std::string(name) + " did not converge in " +
                 std::to_string(settings.max_iterations) + " sweeps (residual " +
                 core::shown(result.residual) + " m)";
}

}  // namespace

Multipliers solve_pgs(const Problem& problem, const Settings& settings)
{
  Multipliers result;
  result.lambda = problem.start;
  const std::vector<Group> groups = groups_of(problem);
  const VecX F = bounds_of(problem);
  const core::Stopwatch watch;
  VecX delta = problem.W * result.lambda + problem.g;
  while (!result.converged && result.iterations < settings.max_iterations) {
    ++result.iterations;
    double step = 0.0;
    for (const Group& group : groups) {
      const Eigen::Index n = group.end - group.first;
      const VecX old = result.lambda.segment(group.first, n);
      const VecX change = solve_group(problem, group, F.segment(group.first, n), old,
                                      delta.segment(group.first, n)) -
                          old;
      delta += problem.W.middleCols(group.first, n) * change;
      result.lambda.segment(group.first, n) += change;
      step += problem.W.diagonal().segment(group.first, n).cwiseProduct(change).cwiseAbs().sum();
    }
    result.converged = stop(problem, settings, step, result);
  }
  result.seconds = watch.seconds();
  finish(problem, settings, "pgs", result);
  return result;
}

namespace {

/// One sweep over the friction rows. Each row is solved with all others fixed; each pair takes one
/// projected gradient step. Returns Σ w |Δλ| [m].
double sweep(const MatX& W, const Bounds& bounds, VecX& delta, VecX& lambda)
{
  double step = 0.0;
  for (int i = 0; i < static_cast<int>(lambda.size()); ++i) {
    const bool pair = bounds.of_pair(i);
    const int n = pair ? 2 : 1;
    const double w = pair ? W(i, i) + W(i + 1, i + 1) : W(i, i);
    if (w > 0.0) {
      const Law law = pair ? Law::disc(bounds.F[i]) : Law::box(bounds.F[i]);
      const VecX change =
          project(law, lambda.segment(i, n) - delta.segment(i, n) / w) - Few(lambda.segment(i, n));
      lambda.segment(i, n) += change;
      delta += W.middleCols(i, n) * change;
      step += w * change.cwiseAbs().sum();
    }
    i += n - 1;
  }
  return step;
}

}  // namespace

Multipliers solve_hybrid(const Problem& problem, const Settings& settings)
{
  Multipliers result;
  result.lambda = problem.start;
  const RowSplit rows = split_rows(problem);
  core::Stopwatch watch;
  const MatX inverse = pseudo_inverse(problem.W(rows.bilateral, rows.bilateral), 1e-10);
  result.factor_seconds = watch.seconds();
  watch = {};
  const MatX W_fb = problem.W(rows.box, rows.bilateral);
  const MatX W_ff = problem.W(rows.box, rows.box);
  const VecX g_b = problem.g(rows.bilateral), g_f = problem.g(rows.box);
  const VecX w_b = problem.W.diagonal()(rows.bilateral);
  VecX lambda_b = result.lambda(rows.bilateral), lambda_f = result.lambda(rows.box);
  while (!result.converged && result.iterations < settings.max_iterations) {
    ++result.iterations;
    const VecX next_b = -inverse * (g_b + W_fb.transpose() * lambda_f);
    double step = w_b.cwiseProduct(next_b - lambda_b).cwiseAbs().sum();
    lambda_b = next_b;
    VecX delta = g_f + W_fb * lambda_b + W_ff * lambda_f;
    step += sweep(W_ff, rows.bounds, delta, lambda_f);
    result.lambda(rows.bilateral) = lambda_b;
    result.lambda(rows.box) = lambda_f;
    result.converged = stop(problem, settings, step, result);
  }
  result.seconds = watch.seconds();
  finish(problem, settings, "hybrid", result);
  return result;
}

}  // namespace trocar::law
