#include "law/solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/words.hpp"
#include "law/cone_interior.hpp"
#include "law/cone_newton.hpp"
#include "law/fixed_sets.hpp"
#include "law/immovable.hpp"

namespace trocar::law {
namespace {

/// A set whose size is min(friction · max(λ_leader, 0), cap) [N]; a fixed set stands in for it.
struct Followed
{
  std::size_t block;  ///< index of the fixed set's block
  int leader;
  double friction, cap;
  double give = 0.0;  ///< largest `mobility` of its rows [m/N]
};

/// The problem with a fixed set in place of each set that follows a multiplier: a box for a
/// follower, an interval and a disc for a cone. The boxes and discs have size 0 at first.
Problem with_fixed_sets(const Problem& problem, std::vector<Followed>& followed)
{
  Problem fixed = problem;
  fixed.blocks.clear();
  for (const Block& block : problem.blocks) {
    const Law& law = block.law;
    if (law.set == Law::Set::follower) {
      const double none = std::numeric_limits<double>::infinity();
      followed.push_back({fixed.blocks.size(), law.leader, law.friction, none});
      fixed.blocks.push_back({block.first, Law::box(0.0), block.point});
    } else if (law.set == Law::Set::cone) {
      fixed.blocks.push_back({block.first, Law::interval(0.0, law.upper), block.point});
      followed.push_back({fixed.blocks.size(), block.first, law.friction, law.shear});
      fixed.blocks.push_back({block.first + 1, Law::disc(0.0), block.point});
    } else {
      fixed.blocks.push_back(block);
    }
  }
  const VecX w = mobility(fixed);
  for (Followed& one : followed) {
    const Block& block = fixed.blocks[one.block];
    one.give = w.segment(block.first, block.law.rows()).maxCoeff();
  }
  return fixed;
}

/// Moves the sizes of the fixed sets by the share `part` towards those that the multipliers ask
/// for. Returns the largest |size asked for - old size| times mobility [m]. For rows without
/// mobility the size itself must settle; until then the result is at least `unsettled` [m].
double follow(const std::vector<Followed>& followed, const VecX& lambda, double part,
              double unsettled, Problem& fixed)
{
  double change = 0.0;
  for (const Followed& one : followed) {
    Block& block = fixed.blocks[one.block];
    const double size = std::min(one.friction * std::max(lambda[one.leader], 0.0), one.cap);
    const double off = std::abs(size - block.law.upper);
    change = std::max(change, one.give * off);
    if (one.give <= 0.0 && off > 1e-9 * size + 1e-12) change = std::max(change, unsettled);
    const double next = block.law.upper + part * (size - block.law.upper);
    block.law = block.law.set == Law::Set::disc ? Law::disc(next) : Law::box(next);
  }
  return change;
}

/// Tresca iteration: solve with fixed sets, take new sizes from the answer, repeat. It ends when
/// the change of the sizes, times mobility [m], and the residual are within the tolerance. The
/// iteration contracts for small friction. Once a change is more than 0.7 of the change before (for
/// example when the sizes overshoot in turn), the sizes move only half the way. The ratio of the
/// last two changes is reported. If the sizes do not settle, the result is not converged and the
/// caller rejects the step.
Multipliers settle_bounds(const Problem& problem, const Settings& settings)
{
  constexpr int most = 50;
  constexpr double slow = 0.7;
  // The other half of the tolerance is for the error of the sizes.
  Settings inner = settings;
  inner.tolerance = 0.5 * settings.tolerance;
  const double unsettled = 2.0 * settings.tolerance;
  std::vector<Followed> followed;
  Problem fixed = with_fixed_sets(problem, followed);
  follow(followed, fixed.start, 1.0, unsettled, fixed);
  Multipliers result;
  int iterations = 0;
  double contraction = 0.0, last_change = 0.0, part = 1.0;
  for (int outer = 1; outer <= most; ++outer) {
    result = solve_fixed_sets(fixed, inner);
    iterations += result.iterations;
    result.iterations = iterations;
    result.outer = outer;
    const double change = follow(followed, result.lambda, part, unsettled, fixed);
    if (last_change > 0.0) contraction = change / last_change;
    result.contraction = contraction;
    last_change = change;
    if (contraction > slow) part = 0.5;
    if (!result.converged) return result;
    result.residual = std::max(result.residual, kkt_residual(problem, result.lambda));
    const bool met = settings.norm == Norm::step || result.residual <= settings.tolerance;
    if (met && change <= settings.tolerance) return result;
    fixed.start = result.lambda;
  }
  result.converged = false;
  result.why = "the friction bounds did not settle in " + std::to_string(most) +
               " solves: the last change was " + core::shown(contraction) + " of the one before";
  return result;
}

constexpr int most_newton = 30;  ///< steps of `cone_newton`

/// Newton's method on all rows from the start, then from what an interior point comes to. Bodies
/// that touch slip, stick and open at many corners: bounds that are settled in turn come to rest
/// slowly or not at all there.
Multipliers solve_touching(const Problem& problem, const Settings& settings)
{
  Multipliers result = cone_newton(problem, settings, most_newton);
  if (result.converged || !all_for_cone_interior(problem)) return result;
  const Multipliers inner = cone_interior(problem, settings);
  Problem again = problem;
  if (inner.lambda.size() == problem.rows()) again.start = inner.lambda;
  const int before = result.iterations + inner.iterations;
  result = cone_newton(again, settings, most_newton);
  result.iterations += before;
  return result;
}

}  // namespace

Multipliers solve(const Problem& problem, const Settings& settings)
{
  const auto follows = [&](const Block& block) {
    return block.law.set == Law::Set::follower || block.law.set == Law::Set::cone;
  };
  const auto touching = std::count_if(problem.blocks.begin(), problem.blocks.end(),
                                      [](const Block& block) { return block.law.one_sided(); });
  const bool newton =
      settings.method == Method::automatic && touching > 1 && all_for_cone_newton(problem);
  int before = 0;
  if (newton) {
    Multipliers result = solve_touching(problem, settings);
    if (result.converged) return result;
    before = result.iterations;
  }
  const bool fixed = std::none_of(problem.blocks.begin(), problem.blocks.end(), follows);
  Multipliers settled =
      fixed ? solve_fixed_sets(problem, settings) : settle_bounds(problem, settings);
  settled.iterations += before;
  if (fixed || !newton || settled.converged || settled.lambda.size() != problem.rows())
    return settled;
  Problem again = problem;
  again.start = settled.lambda;
  Multipliers result = cone_newton(again, settings, most_newton);
  return result.converged ? result : settled;
}

}  // namespace trocar::law
