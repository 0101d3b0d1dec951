#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dense.hpp"
#include "law/box_qp.hpp"

namespace trocar::law {
namespace {

double energy(const BoxQp& qp, const VecX& x)
{
  return x.dot(0.5 * (qp.S * x) + qp.s);
}

/// Minimises over the free rows, the others fixed. If Cholesky meets a vanishing pivot, the result
/// is the minimiser of least norm.
VecX minimise_free(const BoxQp& qp, const VecX& x, const std::vector<int>& free)
{
  VecX held = x;
  for (int i : free) held[i] = 0.0;
  const VecX rhs = -qp.gradient(held)(free);
  const MatX S_ff = qp.S(free, free);
  VecX y = x;
  const core::Cholesky cholesky(S_ff);
  if (cholesky.regular()) y(free) = cholesky.solve(rhs);
  if (!cholesky.regular() || !y.allFinite()) y(free) = core::least_squares(S_ff, rhs);
  return y;
}

/// State of the active-set iteration.
struct Search
{
  VecX x;
  std::vector<bool> free;
  bool cautious = false;  ///< rows change one at a time, because a set did not lower the energy
};

/// Moves x towards y and stops rows at their bounds; y is the minimiser over the free rows and lies
/// outside the box. Returns false when y is not a number.
bool stop_at_bounds(const BoxQp& qp, const VecX& y, Search& search)
{
  const VecX& F = qp.bounds.F;
  double fraction = std::numeric_limits<double>::infinity();
  int first = -1;
  for (int i = 0; i < static_cast<int>(y.size()); ++i) {
    if (!search.free[static_cast<std::size_t>(i)] || std::abs(y[i]) <= F[i]) continue;
    const double bound = y[i] > search.x[i] ? F[i] : -F[i];
    const double reach = (bound - search.x[i]) / (y[i] - search.x[i]);
    if (reach < fraction) {
      fraction = reach;
      first = i;
    }
  }
  if (first < 0) return false;
  VecX met = search.x + fraction * (y - search.x);
  met[first] = y[first] > search.x[first] ? F[first] : -F[first];
  const VecX projected = y.cwiseMax(-F).cwiseMin(F);
  if (!search.cautious && energy(qp, projected) <= energy(qp, met)) {
    search.x = projected;
    for (int i = 0; i < static_cast<int>(y.size()); ++i)
      if (std::abs(search.x[i]) >= F[i]) search.free[static_cast<std::size_t>(i)] = false;
  } else {
    search.x = met;
    search.free[static_cast<std::size_t>(first)] = false;
  }
  return true;
}

/// Frees the rows on bounds where the negative gradient points inwards. Returns false when there is
/// none: then x is optimal. A cautious search frees one row only: the row with the largest
/// |gradient| / S_ii or, if round-off leaves no such row with S_ii > 0, the row with the largest
/// |gradient|.
bool release(const BoxQp& qp, double tolerance, Search& search)
{
  const MatX& S = qp.S;
  const VecX& F = qp.bounds.F;
  const VecX gradient = qp.gradient(search.x);
  std::vector<int> wrong;
  int farthest = -1, steepest = -1;
  double way = 0.0, slope = 0.0;
  for (int i = 0; i < static_cast<int>(F.size()); ++i) {
    if (search.free[static_cast<std::size_t>(i)]) continue;
    const double inward = search.x[i] >= F[i] ? gradient[i] : -gradient[i];
    if (inward <= tolerance) continue;
    wrong.push_back(i);
    if (S(i, i) > 0.0 && inward / S(i, i) > way) {
      way = inward / S(i, i);
      farthest = i;
    }
    if (steepest < 0 || inward > slope) {
      slope = inward;
      steepest = i;
    }
  }
  if (wrong.empty()) return false;
  if (search.cautious)
    search.free[static_cast<std::size_t>(farthest >= 0 ? farthest : steepest)] = true;
  else
    for (int i : wrong) search.free[static_cast<std::size_t>(i)] = true;
  return true;
}

}  // namespace

BoxSolution active_set(const BoxQp& qp, const VecX& start, int max_iterations)
{
  const VecX &s = qp.s, &F = qp.bounds.F;
  BoxSolution result;
  Search search{start, std::vector<bool>(static_cast<std::size_t>(s.size())), false};
  for (int i = 0; i < static_cast<int>(s.size()); ++i)
    search.free[static_cast<std::size_t>(i)] = std::abs(start[i]) < F[i];
  const double tolerance = 1e-13 * (s.cwiseAbs().maxCoeff() + (qp.S * F).cwiseAbs().maxCoeff());
  double best = std::numeric_limits<double>::max();  // finite: infinity - infinity is NaN
  for (int k = 0; k < max_iterations; ++k) {
    std::vector<int> free;
    for (int i = 0; i < static_cast<int>(s.size()); ++i)
      if (search.free[static_cast<std::size_t>(i)]) free.push_back(i);
    if (!free.empty()) {
      const VecX y = minimise_free(qp, search.x, free);
      ++result.factorisations;
      bool leaves = false;
      for (int i : free) leaves = leaves || std::abs(y[i]) > F[i];
      if (leaves) {
        if (!stop_at_bounds(qp, y, search)) break;
        continue;
      }
      search.x = y;
    }
    const double now = energy(qp, search.x);
    if (now >= best - 1e-15 * std::abs(best)) search.cautious = true;
    best = std::min(best, now);
    if (!release(qp, tolerance, search)) {
      result.finished = true;
      break;
    }
  }
  result.x = search.x;
  return result;
}

}  // namespace trocar::law
