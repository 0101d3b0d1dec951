#include "law/solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/words.hpp"
#include "law/fixed_sets.hpp"
#include "law/immovable.hpp"

namespace trocar::law {
namespace {

/// A set whose size follows a multiplier, and its stand-in of fixed size.
struct Followed
{
  std::size_t block;  ///< of the problem with fixed sets
  int leader;
  double friction, cap;
  double give = 0.0;  ///< mobility of its rows [m/N]
};

/// The problem with fixed sets in the place of those that follow: a follower is a box, a cone an
/// interval and a disc.
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

/// Takes `part` of the way to the sizes that multipliers ask for. Returns how far off they were, in
/// the gap that makes [m]; where nothing moves there is no gap to judge it by: the size itself must
/// settle, and if not that counts as `unsettled`.
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

/// Tresca iteration: solve with fixed sets, take their sizes from the answer, again, until they
/// change by less than the tolerance (in the gap they make). For small friction it contracts; where
/// it hardly does, as when sizes overshoot in turn, they go half the way. The ratio of the last
/// two changes is reported, and when they do not settle the step is refused.
Multipliers settle_bounds(const Problem& problem, const Settings& settings)
{
  constexpr int most = 50;
  constexpr double slow = 0.7;
  // Half of the tolerance is for sizes that are not there yet.
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

}  // namespace

Multipliers solve(const Problem& problem, const Settings& settings)
{
  const auto follows = [](const Block& block) {
    return block.law.set == Law::Set::follower || block.law.set == Law::Set::cone;
  };
  if (std::none_of(problem.blocks.begin(), problem.blocks.end(), follows))
    return solve_fixed_sets(problem, settings);
  return settle_bounds(problem, settings);
}

}  // namespace trocar::law
