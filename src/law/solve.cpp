#include "law/solve.hpp"

#include <cmath>

#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "law/box_qp.hpp"
#include "law/condensed.hpp"
#include "law/gauss_seidel.hpp"

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
  result.nonunique = condensed.bilateral_redundant() || box_rank < condensed.box_rows();
  if (!result.converged) result.why = complaint(problem, settings, result);
  return result;
}

Problem restrict(const Problem& problem, const std::vector<int>& rows)
{
  Problem part;
  part.W = problem.W(rows, rows);
  // A soft row is a hard one in series with its softness.
  if (problem.softness.size() > 0) part.W.diagonal() += problem.softness(rows);
  part.g = problem.g(rows);
  part.bound = problem.bound(rows);
  part.start = problem.start(rows);
  for (int row : rows) {
    part.kind.push_back(problem.kind[static_cast<std::size_t>(row)]);
    part.group.push_back(problem.group[static_cast<std::size_t>(row)]);
  }
  return part;
}

}  // namespace

VecX mobility(const Problem& problem)
{
  VecX w = problem.W.diagonal();
  if (w.size() == 0) return w;
  const double smallest = 1e-14 * w.maxCoeff();
  for (double& value : w)
    if (value <= smallest) value = 0.0;
  return w;
}

Multipliers solve(const Problem& problem, const Settings& settings)
{
  const VecX w = mobility(problem);
  std::vector<int> rows;  // those that something can move
  for (int i = 0; i < static_cast<int>(w.size()); ++i)
    if (w[i] > 0.0) rows.push_back(i);
  Multipliers result;
  if (rows.empty()) {
    result.converged = true;
  } else {
    const Problem part = restrict(problem, rows);
    if (settings.method == Method::pgs)
      result = solve_pgs(part, settings);
    else if (settings.method == Method::hybrid)
      result = solve_hybrid(part, settings);
    else
      result = solve_condensed(part, settings);
  }
  VecX lambda = VecX::Zero(problem.rows());
  if (!rows.empty()) lambda(rows) = result.lambda;
  result.lambda = lambda;
  result.delta = problem.W * lambda + problem.g;
  if (!result.delta.allFinite()) {
    result.converged = false;
    result.why = "a multiplier is not finite";
  }
  return result;
}

}  // namespace trocar::law
