#include "law/gauss_seidel.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/dense.hpp"
#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "law/condensed.hpp"

namespace trocar::law {
namespace {

/// Rows first .. end-1 form one coupling point.
struct Group
{
  Eigen::Index first, end;
};

std::vector<Group> groups_of(const Problem& problem)
{
  std::vector<Group> groups;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i == 0 || problem.group[at] != problem.group[at - 1]) groups.push_back({i, i});
    groups.back().end = i + 1;
  }
  return groups;
}

/// Multipliers of one group that satisfy its laws with every other row held. `residual` is δ of
/// its rows. A group holds at most one box row: solve all rows as bilateral; when that one leaves
/// its box, put it on the bound and solve the rest again.
VecX solve_group(const Problem& problem, const Group& group, const VecX& lambda,
                 const VecX& residual)
{
  const Eigen::Index n = group.end - group.first;
  const MatX W = problem.W.block(group.first, group.first, n, n);
  const VecX held = residual - W * lambda;  // δ of the group at λ_group = 0
  std::vector<int> free;
  VecX next = VecX::Zero(n);
  for (int i = 0; i < n; ++i)
    if (W(i, i) > 0.0) free.push_back(i);
  const auto solve_free = [&] {
    if (free.empty()) return;
    const VecX rhs = -(held + W * next)(free);
    next(free) = core::least_squares(W(free, free), rhs);
  };
  solve_free();
  for (int i = 0; i < n; ++i) {
    const Eigen::Index row = group.first + i;
    if (problem.kind[static_cast<std::size_t>(row)] != RowKind::box) continue;
    const double F = problem.bound[row];
    if (std::abs(next[i]) <= F) continue;
    const double clamped = std::clamp(next[i], -F, F);
    free.erase(std::remove(free.begin(), free.end(), i), free.end());
    next.setZero();
    next[i] = clamped;
    solve_free();
  }
  return next;
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
  const core::Stopwatch watch;
  VecX delta = problem.W * result.lambda + problem.g;
  while (!result.converged && result.iterations < settings.max_iterations) {
    ++result.iterations;
    double step = 0.0;
    for (const Group& group : groups) {
      const Eigen::Index n = group.end - group.first;
      const VecX old = result.lambda.segment(group.first, n);
      const VecX change = solve_group(problem, group, old, delta.segment(group.first, n)) - old;
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
  const VecX bound = problem.bound(rows.box);
  const VecX w_b = problem.W.diagonal()(rows.bilateral);
  VecX lambda_b = result.lambda(rows.bilateral), lambda_f = result.lambda(rows.box);
  while (!result.converged && result.iterations < settings.max_iterations) {
    ++result.iterations;
    const VecX next_b = -inverse * (g_b + W_fb.transpose() * lambda_f);
    double step = w_b.cwiseProduct(next_b - lambda_b).cwiseAbs().sum();
    lambda_b = next_b;
    VecX delta = g_f + W_fb * lambda_b + W_ff * lambda_f;
    for (Eigen::Index i = 0; i < lambda_f.size(); ++i) {
      if (W_ff(i, i) <= 0.0) continue;
      const double next = std::clamp(lambda_f[i] - delta[i] / W_ff(i, i), -bound[i], bound[i]);
      const double change = next - lambda_f[i];
      lambda_f[i] = next;
      delta += W_ff.col(i) * change;
      step += std::abs(W_ff(i, i) * change);
    }
    result.lambda(rows.bilateral) = lambda_b;
    result.lambda(rows.box) = lambda_f;
    result.converged = stop(problem, settings, step, result);
  }
  result.seconds = watch.seconds();
  finish(problem, settings, "hybrid", result);
  return result;
}

}  // namespace trocar::law
