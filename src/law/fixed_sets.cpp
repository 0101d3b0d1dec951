#include "law/fixed_sets.hpp"

#include <algorithm>
#include <cmath>

#include "law/condensed_solver.hpp"
#include "law/gauss_seidel.hpp"
#include "law/immovable.hpp"

namespace trocar::law {
namespace {

/// Half width and middle of the set of every row [N]. Huge and infinite limits would drown the
/// other rows in round-off. They are drawn in to about `reach` times the force that closes the
/// row's gap when the row acts alone.
struct Intervals
{
  VecX half, middle;
  std::vector<bool> drawn_low, drawn_high;  ///< by block: this limit was drawn in
};

Intervals intervals(const Problem& problem, const VecX& w, double reach)
{
  const Eigen::Index n = problem.rows();
  const std::vector<bool> none(problem.blocks.size(), false);
  Intervals result{VecX::Zero(n), VecX::Zero(n), none, none};
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    const int rows = block.law.rows();
    const double give = w.segment(block.first, rows).maxCoeff();
    if (block.law.set == Law::Set::zero || give <= 0.0) continue;
    const bool disc = block.law.set == Law::Set::disc;
    const double least = disc ? 0.0 : std::clamp(0.0, block.law.lower, block.law.upper);
    const double far = reach * (problem.g.segment(block.first, rows).norm() / give +
                                problem.start.segment(block.first, rows).norm() + 1e-9) +
                       std::abs(least);
    const double upper = std::min(block.law.upper, far);
    const double lower = disc ? -upper : std::max(block.law.lower, -far);
    result.drawn_high[b] = upper < block.law.upper;
    result.drawn_low[b] = !disc && lower > block.law.lower;
    result.half.segment(block.first, rows).setConstant(0.5 * (upper - lower));
    result.middle.segment(block.first, rows).setConstant(0.5 * (upper + lower));
  }
  return result;
}

/// True when a multiplier lies at a limit that was drawn in.
bool held_back(const Problem& problem, const Intervals& interval, const VecX& lambda)
{
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    if (!interval.drawn_low[b] && !interval.drawn_high[b]) continue;
    const int first = problem.blocks[b].first, rows = problem.blocks[b].law.rows();
    const VecX away = lambda.segment(first, rows) - interval.middle.segment(first, rows);
    const double end = interval.half[first] * (1.0 - 1e-9);
    const bool low = interval.drawn_low[b] && -away[0] >= end;
    const bool high = interval.drawn_high[b] && (rows == 1 ? away[0] : away.norm()) >= end;
    if (low || high) return true;
  }
  return false;
}

/// Some blocks of a problem, and their rows.
struct Chosen
{
  std::vector<const Block*> blocks{};
  std::vector<int> rows{};
};

/// The blocks that something can move and whose set is more than a single point.
Chosen choose(const Problem& problem, const VecX& w, const Intervals& interval)
{
  Chosen chosen;
  for (const Block& block : problem.blocks) {
    const bool moves = w.segment(block.first, block.law.rows()).maxCoeff() > 0.0;
    const bool choice = block.law.set == Law::Set::zero || interval.half[block.first] > 0.0;
    if (!moves || !choice) continue;
    chosen.blocks.push_back(&block);
    for (int row = block.first; row < block.end(); ++row) chosen.rows.push_back(row);
  }
  return chosen;
}

/// The problem on the chosen blocks. Its multipliers are counted from the middles of their sets.
Problem restrict(const Problem& problem, const Chosen& chosen, const Intervals& interval)
{
  const std::vector<int>& rows = chosen.rows;
  Problem part;
  int first = 0;
  for (const Block* block : chosen.blocks) {
    Law law = block->law;
    if (law.set == Law::Set::interval) law = Law::box(interval.half[block->first]);
    if (law.set == Law::Set::disc) law = Law::disc(interval.half[block->first]);
    part.blocks.push_back({first, law, block->point});
    first += law.rows();
  }
  part.W = problem.W(rows, rows);
  // W λ + g = -c λ is solved as a row without compliance, (W + c) λ + g = 0.
  if (problem.compliance.size() > 0) part.W.diagonal() += problem.compliance(rows);
  part.g = problem.g(rows);
  if (!interval.middle.isZero(0.0)) part.g += (problem.W * interval.middle)(rows);
  part.start = (problem.start - interval.middle)(rows);
  return part;
}

Multipliers solve_within(const Problem& problem, const VecX& w, const Intervals& interval,
                         const Settings& settings)
{
  const Chosen chosen = choose(problem, w, interval);
  Multipliers result;
  if (chosen.rows.empty()) {
    result.converged = true;
    result.lambda = interval.middle;
    return result;
  }
  const Problem part = restrict(problem, chosen, interval);
  if (settings.method == Method::pgs)
    result = solve_pgs(part, settings);
  else if (settings.method == Method::hybrid)
    result = solve_hybrid(part, settings);
  else
    result = solve_condensed(part, settings);
  VecX lambda = interval.middle;
  lambda(chosen.rows) += result.lambda;
  result.lambda = lambda;
  return result;
}

}  // namespace

Multipliers solve_fixed_sets(const Problem& problem, const Settings& settings)
{
  constexpr double first_reach = 1e4;
  constexpr double last_reach = 1e12;
  const VecX w = mobility(problem);
  Multipliers result;
  int iterations = 0;
  double seconds = 0.0, factor_seconds = 0.0;
  bool drawn = true;
  for (double reach = first_reach; drawn && reach <= last_reach; reach *= 1e4) {
    const Intervals interval = intervals(problem, w, reach);
    result = solve_within(problem, w, interval, settings);
    result.iterations = iterations += result.iterations;
    result.seconds = seconds += result.seconds;
    result.factor_seconds = factor_seconds += result.factor_seconds;
    drawn = held_back(problem, interval, result.lambda);
  }
  if (result.converged && drawn) {
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

}  // namespace trocar::law
