#include "law/condensed_solver.hpp"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.hpp"
#include "core/words.hpp"
#include "law/gauss_seidel.hpp"
#include "law/schur_complement.hpp"

namespace trocar::law {

namespace {

constexpr int most_interior_steps = 100;
constexpr int most_warm_sets = 6;      ///< limit of iterations of `primal_dual_active_set`
constexpr int most_newton_steps = 12;  ///< limit of iterations of `pair_newton`
constexpr double box_tolerance = 0.1;  ///< share of the tolerance that the interior point stops at

VecX take(const BoxSolution& answer, Multipliers& result)
{
  result.iterations += answer.factorisations;
  return answer.x;
}

VecX interior(SchurComplement& schur, const Settings& settings, Multipliers& result)
{
  return take(interior_point(schur.qp(), schur.start(), box_tolerance * settings.tolerance,
                             std::min(settings.max_iterations, most_interior_steps)),
              result);
}

VecX active_set_search(SchurComplement& schur, const VecX& start, const Settings& settings,
                       Multipliers& result)
{
  return take(active_set(schur.qp(), start, settings.max_iterations), result);
}

/// Multipliers of the box rows in a problem with discs [N]. Newton's method starts from the last
/// step, unless the user asked for the interior point. If it does not finish, the interior point
/// gives Newton's method a new start.
VecX discs(SchurComplement& schur, const Settings& settings, Multipliers& result)
{
  const auto newton = [&](const VecX& start) {
    return pair_newton(schur.qp(), start, settings.tolerance,
                       std::min(settings.max_iterations, most_newton_steps));
  };
  if (settings.method != Method::interior_point) {
    const BoxSolution warm = newton(schur.start());
    const VecX x = take(warm, result);
    if (warm.finished) return x;
  }
  return take(newton(interior(schur, settings, result)), result);
}

/// Multipliers of the box rows [N] by the first method that succeeds: all rows slip (needs no S);
/// the primal-dual active set from the last step's sets; the interior point, whose cost hardly
/// depends on how many rows change.
VecX automatic(SchurComplement& schur, const Settings& settings, Multipliers& result)
{
  if (const std::optional<VecX> slipping = schur.all_slipping()) return *slipping;
  const BoxQp qp = schur.qp();
  const BoxSolution warm =
      primal_dual_active_set(qp, schur.start(), settings.tolerance, most_warm_sets);
  VecX x = take(warm, result);
  if (!warm.finished || !(box_residual(qp, x) <= settings.tolerance))
    x = interior(schur, settings, result);
  return x;
}

void check_kkt(const Problem& problem, const Settings& settings, const VecX& lambda,
               Multipliers& result)
{
  result.lambda = lambda;
  result.residual = kkt_residual(problem, lambda);
  result.converged = result.residual <= settings.tolerance;
}

/// Largest |δ| of the bilateral rows [m]; no solver of the box rows can reduce it.
double bilateral_residual(const Problem& problem, const VecX& lambda)
{
  const std::vector<int> rows = split_rows(problem).bilateral;
  const VecX delta = problem.W * lambda + problem.g;
  return rows.empty() ? 0.0 : delta(rows).cwiseAbs().maxCoeff();
}

/// Gauss-Seidel sweeps from the multipliers of the other solvers, kept if they lower the residual.
void sweep_on(const Problem& problem, const Settings& settings, Multipliers& result)
{
  Problem again = problem;
  again.start = result.lambda;
  const Multipliers swept = solve_pgs(again, settings);
  result.iterations += swept.iterations;
  if (swept.residual < result.residual) check_kkt(problem, settings, swept.lambda, result);
}

void solve_boxes(const Problem& problem, const Settings& settings, SchurComplement& schur,
                 Multipliers& result)
{
  const bool with_discs = !schur.bounds().pairs.empty();
  VecX lambda_f;
  if (with_discs)
    lambda_f = discs(schur, settings, result);
  else if (settings.method == Method::interior_point)
    lambda_f = interior(schur, settings, result);
  else if (settings.method == Method::active_set)
    lambda_f = active_set_search(schur, schur.start(), settings, result);
  else
    lambda_f = automatic(schur, settings, result);
  check_kkt(problem, settings, schur.expand(lambda_f), result);
  if (result.converged || settings.method != Method::automatic) return;
  if (bilateral_residual(problem, result.lambda) > settings.tolerance) return;
  if (with_discs) return sweep_on(problem, settings, result);
  lambda_f = active_set_search(schur, lambda_f, settings, result);
  check_kkt(problem, settings, schur.expand(lambda_f), result);
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

}  // namespace

Multipliers solve_condensed(const Problem& problem, const Settings& settings)
{
  Multipliers result;
  core::Stopwatch watch;
  SchurComplement schur(problem);
  result.factor_seconds = watch.seconds();
  watch = {};
  if (schur.box_rows() == 0)
    check_kkt(problem, settings, schur.expand(VecX()), result);
  else
    solve_boxes(problem, settings, schur, result);
  result.seconds = watch.seconds();
  const int box_rank = schur.box_rank();
  result.rank = schur.bilateral_rank() + box_rank;
  result.condition = schur.bilateral_condition();
  result.nonunique = schur.bilateral_redundant() || box_rank < schur.box_rows();
  if (!result.converged) result.why = complaint(problem, settings, result);
  return result;
}

}  // namespace trocar::law
