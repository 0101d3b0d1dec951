#include "law/solve.hpp"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "law/box_qp.hpp"
#include "law/condensed.hpp"
#include "law/gauss_seidel.hpp"
#include "law/immovable.hpp"

namespace trocar::law {

namespace {

constexpr int most_interior_steps = 100;
constexpr int most_warm_sets = 6;      ///< factorisations to get there from the last step's sets
constexpr double box_tolerance = 0.1;  ///< of the tolerance: what the box rows may leave of it

VecX take(const BoxSolution& answer, Multipliers& result)
{
  result.iterations += answer.factorisations;
  return answer.x;
}

VecX interior(Condensed& condensed, const Settings& settings, Multipliers& result)
{
  return take(interior_point(condensed.S(), condensed.s(), condensed.bound(), condensed.start(),
                             box_tolerance * settings.tolerance,
                             std::min(settings.max_iterations, most_interior_steps)),
              result);
}

VecX walk(Condensed& condensed, const VecX& start, const Settings& settings, Multipliers& result)
{
  return take(
      active_set(condensed.S(), condensed.s(), condensed.bound(), start, settings.max_iterations),
      result);
}

/// All slipping as they did, which needs no S; or last step's sets, when they lead on; or the
/// interior point, whose cost hardly depends on how many rows change.
VecX automatic(Condensed& condensed, const Settings& settings, Multipliers& result)
{
  if (const std::optional<VecX> slipping = condensed.all_slipping()) return *slipping;
  const MatX& S = condensed.S();
  const VecX &s = condensed.s(), &F = condensed.bound();
  const BoxSolution warm =
      set_newton(S, s, F, condensed.start(), settings.tolerance, most_warm_sets);
  VecX x = take(warm, result);
  if (!warm.finished || !(box_residual(S, s, F, x) <= settings.tolerance))
    x = interior(condensed, settings, result);
  return x;
}

void judge(const Problem& problem, const Settings& settings, const VecX& lambda,
           Multipliers& result)
{
  result.lambda = lambda;
  result.residual = kkt_residual(problem, lambda);
  result.converged = result.residual <= settings.tolerance;
}

/// Worst |δ| of the bilateral rows [m]: no box solver can mend it.
double bilateral_residual(const Problem& problem, const VecX& lambda)
{
  const std::vector<int> rows = split_rows(problem).bilateral;
  const VecX delta = problem.W * lambda + problem.g;
  return rows.empty() ? 0.0 : delta(rows).cwiseAbs().maxCoeff();
}

void solve_boxes(const Problem& problem, const Settings& settings, Condensed& condensed,
                 Multipliers& result)
{
  VecX lambda_f;
  if (settings.method == Method::interior_point)
    lambda_f = interior(condensed, settings, result);
  else if (settings.method == Method::active_set)
    lambda_f = walk(condensed, condensed.start(), settings, result);
  else
    lambda_f = automatic(condensed, settings, result);
  judge(problem, settings, condensed.expand(lambda_f), result);
  if (result.converged || settings.method != Method::automatic) return;
  if (bilateral_residual(problem, result.lambda) > settings.tolerance) return;
  lambda_f = walk(condensed, lambda_f, settings, result);
  judge(problem, settings, condensed.expand(lambda_f), result);
}

std::string complaint(const Problem& problem, const Settings& settings, const Multipliers& result)
{
  const double bilateral = bilateral_residual(problem, result.lambda);
  const bool contradict = bilateral > settings.tolerance;
  return "the constraints could not be met: residual " + core::shown(result.residual) +
         " m after " + std::to_string(result.iterations) + " factorisations, rank " +
         std::to_string(result.rank) + " of " + std::to_string(problem.rows()) + " rows" +
         (contradict ? ", redundant rows contradict each other by " + core::shown(bilateral) + " m"
                     : "");
}

Multipliers solve_condensed(const Problem& problem, const Settings& settings)
{
  Multipliers result;
  core::Stopwatch watch;
  Condensed condensed(problem);
  result.factor_seconds = watch.seconds();
  watch = {};
  if (condensed.box_rows() == 0)
    judge(problem, settings, condensed.expand(VecX()), result);
  else
    solve_boxes(problem, settings, condensed, result);
  result.seconds = watch.seconds();
  const int box_rank = condensed.box_rank();
  result.rank = condensed.bilateral_rank() + box_rank;
  result.condition = condensed.bilateral_condition();
  result.nonunique = condensed.bilateral_redundant() || box_rank < condensed.box_rows();
  if (!result.converged) result.why = complaint(problem, settings, result);
  return result;
}

/// Half the width and the middle of every row's interval of multipliers [N], no wider than `reach`
/// times what holds the row alone: huge and infinite limits would drown the rest in round-off.
struct Intervals
{
  VecX half, middle;
  std::vector<bool> drawn_in;
};

Intervals intervals(const Problem& problem, const VecX& w, double reach)
{
  const Eigen::Index n = problem.rows();
  Intervals result{VecX::Zero(n), VecX::Zero(n), std::vector<bool>(static_cast<std::size_t>(n))};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (problem.kind[at] == RowKind::bilateral || w[i] <= 0.0) continue;
    const double far = reach * (std::abs(problem.g[i]) / w[i] + std::abs(problem.start[i]) + 1e-9);
    const double bound = std::min(problem.bound[i], far);
    result.drawn_in[at] = bound < problem.bound[i];
    result.half[i] = problem.kind[at] == RowKind::push ? 0.5 * bound : bound;
    if (problem.kind[at] == RowKind::push) result.middle[i] = result.half[i];
  }
  return result;
}

/// Problem on some rows, in multipliers counted from the middles of their intervals.
Problem restrict(const Problem& problem, const std::vector<int>& rows, const Intervals& interval)
{
  Problem part;
  part.W = problem.W(rows, rows);
  // A soft row is a hard one in series with its softness.
  if (problem.softness.size() > 0) part.W.diagonal() += problem.softness(rows);
  part.g = problem.g(rows);
  if (!interval.middle.isZero(0.0)) part.g += (problem.W * interval.middle)(rows);
  part.bound = interval.half(rows);
  part.start = (problem.start - interval.middle)(rows);
  for (int row : rows) {
    const RowKind kind = problem.kind[static_cast<std::size_t>(row)];
    part.kind.push_back(kind == RowKind::push ? RowKind::box : kind);
    part.group.push_back(problem.group[static_cast<std::size_t>(row)]);
  }
  return part;
}

Multipliers solve_within(const Problem& problem, const VecX& w, const Intervals& interval,
                         const Settings& settings)
{
  std::vector<int> rows;  // those that something can move and whose multiplier has a choice
  for (int i = 0; i < static_cast<int>(w.size()); ++i) {
    const bool hard = problem.kind[static_cast<std::size_t>(i)] == RowKind::bilateral;
    if (w[i] > 0.0 && (hard || interval.half[i] > 0.0)) rows.push_back(i);
  }
  Multipliers result;
  if (rows.empty()) {
    result.converged = true;
    result.lambda = interval.middle;
    return result;
  }
  const Problem part = restrict(problem, rows, interval);
  if (settings.method == Method::pgs)
    result = solve_pgs(part, settings);
  else if (settings.method == Method::hybrid)
    result = solve_hybrid(part, settings);
  else
    result = solve_condensed(part, settings);
  VecX lambda = interval.middle;
  lambda(rows) += result.lambda;
  result.lambda = lambda;
  return result;
}

Multipliers solve_fixed(const Problem& problem, const Settings& settings)
{
  constexpr double first_reach = 1e4;
  constexpr double last_reach = 1e12;
  const VecX w = mobility(problem);
  Multipliers result;
  int iterations = 0;
  double seconds = 0.0, factor_seconds = 0.0;
  bool at_drawn_bound = true;
  for (double reach = first_reach; at_drawn_bound && reach <= last_reach; reach *= 1e4) {
    const Intervals interval = intervals(problem, w, reach);
    result = solve_within(problem, w, interval, settings);
    result.iterations = iterations += result.iterations;
    result.seconds = seconds += result.seconds;
    result.factor_seconds = factor_seconds += result.factor_seconds;
    at_drawn_bound = false;
    for (Eigen::Index i = 0; i < problem.rows(); ++i) {
      const double away = problem.kind[static_cast<std::size_t>(i)] == RowKind::push
                              ? result.lambda[i] - interval.middle[i]
                              : std::abs(result.lambda[i]);
      at_drawn_bound = at_drawn_bound || (interval.drawn_in[static_cast<std::size_t>(i)] &&
                                          away >= interval.half[i] * (1.0 - 1e-9));
    }
  }
  if (result.converged && at_drawn_bound) {
    result.converged = false;
    result.why = "a multiplier grows without bound: rows contradict each other";
  }
  settle_immovable(problem, w, settings.tolerance, result);
  result.delta = problem.W * result.lambda + problem.g;
  if (!result.delta.allFinite()) {
    result.converged = false;
    result.why = "a multiplier is not finite";
  }
  return result;
}

/// Tresca iteration: solve with fixed bounds, take the bounds from the answer, again, until they
/// change by less than the tolerance (in the gap they make). For small friction it contracts; where
/// it hardly does, as when bounds overshoot in turn, they go half the way. The ratio of the last
/// two changes is reported, and when they do not settle the step is refused.
Multipliers settle_bounds(Problem problem, const Settings& settings)
{
  constexpr int most = 50;
  constexpr double slow = 0.7;
  const VecX w = mobility(problem);
  double part = 1.0;
  const auto set_bounds = [&](const VecX& lambda) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < problem.rows(); ++i) {
      const int normal = problem.normal[static_cast<std::size_t>(i)];
      if (normal < 0) continue;
      const double bound = problem.friction[i] * std::max(lambda[normal], 0.0);
      const double off = std::abs(bound - problem.bound[i]);
      change = std::max(change, w[i] * off);
      // Where nothing moves there is no gap to judge it by: the bound itself must settle.
      if (w[i] <= 0.0 && off > 1e-9 * bound + 1e-12)
        change = std::max(change, 2.0 * settings.tolerance);
      problem.bound[i] += part * (bound - problem.bound[i]);
    }
    return change;
  };
  set_bounds(problem.start);
  Multipliers result;
  int iterations = 0;
  double contraction = 0.0;
  double last_change = 0.0;
  for (int outer = 1; outer <= most; ++outer) {
    result = solve_fixed(problem, settings);
    iterations += result.iterations;
    result.iterations = iterations;
    result.outer = outer;
    const double change = set_bounds(result.lambda);
    if (last_change > 0.0) contraction = change / last_change;
    result.contraction = contraction;
    last_change = change;
    if (contraction > slow) part = 0.5;
    if (!result.converged || change <= settings.tolerance) return result;
    problem.start = result.lambda;
  }
  result.converged = false;
  result.why = "the friction bounds did not settle in " + std::to_string(most) +
               " solves: the last change was " + core::shown(contraction) + " of the one before";
  return result;
}

}  // namespace

Multipliers solve(const Problem& problem, const Settings& settings)
{
  const auto depends = [](int normal) { return normal >= 0; };
  if (std::none_of(problem.normal.begin(), problem.normal.end(), depends))
    return solve_fixed(problem, settings);
  return settle_bounds(problem, settings);
}

}  // namespace trocar::law
