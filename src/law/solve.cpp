#include "law/solve.hpp"

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
