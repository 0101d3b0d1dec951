#include "law/solve.hpp"

#include <algorithm>
#include <cmath>

#include "core/words.hpp"
#include "law/box_qp.hpp"
#include "law/condensed.hpp"
#include "law/gauss_seidel.hpp"

namespace trocar::law {
namespace {

VecX run(Method method, const Condensed& condensed, const VecX& start, const Settings& settings,
         Multipliers& result)
{
  const BoxSolution answer = method == Method::interior_point
                                 ? interior_point(condensed.S(), condensed.s(), condensed.bound(),
                                                  1e-12, std::min(settings.max_iterations, 100))
                                 : active_set(condensed.S(), condensed.s(), condensed.bound(),
                                              start, settings.max_iterations);
  result.iterations += answer.factorisations;
  return answer.x;
}

void judge(const Problem& problem, const Settings& settings, const VecX& lambda,
           Multipliers& result)
{
  result.lambda = lambda;
  result.residual = kkt_residual(problem, lambda);
  result.converged = result.residual <= settings.tolerance;
}

Multipliers solve_condensed(const Problem& problem, const Settings& settings)
{
  Multipliers result;
  const Condensed condensed(problem);
  const int box_rows = static_cast<int>(condensed.s().size());
  const int box_rank = condensed.box_rank();
  result.rank = condensed.bilateral_rank() + box_rank;
  result.nonunique = condensed.bilateral_redundant() || box_rank < box_rows;
  if (box_rows == 0) {
    judge(problem, settings, condensed.expand(VecX()), result);
  } else {
    Method first = settings.method;
    if (first == Method::automatic)
      first = box_rank < box_rows ? Method::interior_point : Method::active_set;
    VecX lambda_f = run(first, condensed, condensed.start(), settings, result);
    judge(problem, settings, condensed.expand(lambda_f), result);
    if (!result.converged && settings.method == Method::automatic) {
      const Method other =
          first == Method::active_set ? Method::interior_point : Method::active_set;
      // The active set starts from the interior point's answer: it only has to polish it.
      lambda_f = run(other, condensed, lambda_f, settings, result);
      judge(problem, settings, condensed.expand(lambda_f), result);
    }
  }
  if (!result.converged)
    result.why = "the constraints could not be met: residual " + core::shown(result.residual) +
                 " m after " + std::to_string(result.iterations) + " factorisations, rank " +
                 std::to_string(result.rank) + " of " + std::to_string(problem.rows()) + " rows";
  return result;
}

}  // namespace

VecX mobility(const Problem& problem)
{
  // What is prescribed has columns that are exactly zero. A relative cut would also take rows of
  // stiff bodies beside very soft ones.
  return problem.W.diagonal().cwiseMax(0.0);
}

namespace {

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
  part.g = (problem.g + problem.W * interval.middle)(rows);
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
  bool at_drawn_bound = true;
  for (double reach = first_reach; at_drawn_bound && reach <= last_reach; reach *= 1e4) {
    const Intervals interval = intervals(problem, w, reach);
    result = solve_within(problem, w, interval, settings);
    result.iterations = iterations += result.iterations;
    at_drawn_bound = false;
    for (Eigen::Index i = 0; i < problem.rows(); ++i) {
      const double away = problem.kind[static_cast<std::size_t>(i)] == RowKind::push
                              ? result.lambda[i] - interval.middle[i]
                              : std::abs(result.lambda[i]);
      at_drawn_bound = at_drawn_bound || (interval.drawn_in[static_cast<std::size_t>(i)] &&
                                          away >= interval.half[i] * (1.0 - 1e-9));
    }
  }
  result.delta = problem.W * result.lambda + problem.g;
  if (!result.delta.allFinite()) {
    result.converged = false;
    result.why = "a multiplier is not finite";
  }
  return result;
}

/// Tresca iteration: solve with fixed bounds, take the bounds from the answer, again, until they
/// change by less than the tolerance (in the gap they make). For small friction it contracts; the
/// ratio of the last two changes is reported, and when they do not settle the step is refused.
Multipliers settle_bounds(Problem problem, const Settings& settings)
{
  constexpr int most = 50;
  const VecX w = mobility(problem);
  const auto set_bounds = [&](const VecX& lambda) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < problem.rows(); ++i) {
      const int normal = problem.normal[static_cast<std::size_t>(i)];
      if (normal < 0) continue;
      const double bound = problem.friction[i] * std::max(lambda[normal], 0.0);
      change = std::max(change, w[i] * std::abs(bound - problem.bound[i]));
      problem.bound[i] = bound;
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
