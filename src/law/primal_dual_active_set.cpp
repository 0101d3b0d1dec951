#include <algorithm>
#include <cmath>
#include <vector>

#include "core/dense.hpp"
#include "law/box_qp.hpp"

namespace trocar::law {
namespace {

/// State of every row: 0 free, -1 or 1 on the lower or upper bound.
using Sets = std::vector<signed char>;

Sets sets_of(const VecX& x, const VecX& F)
{
  Sets sets(static_cast<std::size_t>(x.size()), 0);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (std::abs(x[i]) >= F[i]) sets[static_cast<std::size_t>(i)] = x[i] > 0.0 ? 1 : -1;
  return sets;
}

/// Minimisation with the rows of `sets` held on their bounds. Holds a factor of H on the free rows.
struct Held
{
  Sets sets;
  std::vector<int> free{};
  core::Cholesky cholesky{};

  /// Factors H on the free rows. Returns false when H is not positive definite there, by round-off.
  bool factor(const MatX& H)
  {
    free.clear();
    for (int i = 0; i < static_cast<int>(sets.size()); ++i)
      if (sets[static_cast<std::size_t>(i)] == 0) free.push_back(i);
    if (free.empty()) return true;
    cholesky.compute(H(free, free));
    return cholesky.regular();
  }

  /// Puts the held rows of x on their bounds and minimises ½ xᵀHx + hᵀx over the free rows.
  VecX minimise(const MatX& H, const VecX& h, const VecX& F, VecX x) const
  {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (const int side = sets[static_cast<std::size_t>(i)]; side != 0) x[i] = side * F[i];
    if (free.empty()) return x;
    const VecX gradient = H * x + h;
    x(free) -= cholesky.solve(VecX(gradient(free)));
    return x;
  }
};

/// The sets of the next iteration. Free rows outside the box go on their bounds. Held rows go free
/// where the negative gradient points inwards and is larger than the tolerance.
Sets next_sets(const VecX& x, const VecX& gradient, const VecX& F, const Sets& sets,
               double tolerance)
{
  Sets next = sets;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    signed char& side = next[static_cast<std::size_t>(i)];
    if (side == 0 && std::abs(x[i]) > F[i])
      side = x[i] > 0.0 ? 1 : -1;
    else if (side * gradient[i] > tolerance && F[i] > 0.0)
      side = 0;
  }
  return next;
}

int differences(const Sets& a, const Sets& b)
{
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

}  // namespace

BoxSolution primal_dual_active_set(const BoxQp& qp, const VecX& start, double tolerance,
                                   int max_iterations)
{
  const VecX& F = qp.bounds.F;
  const double shift = 0.1 * tolerance / std::max(F.maxCoeff(), 1e-300);
  MatX H = qp.S;
  H.diagonal().array() += shift;
  BoxSolution result;
  result.x = start.cwiseMax(-F).cwiseMin(F);
  const VecX h = qp.s - shift * result.x;
  Held held{sets_of(result.x, F)};
  VecX x = result.x;
  int changes = static_cast<int>(x.size()) + 1;
  while (!result.finished && result.factorisations < max_iterations) {
    ++result.factorisations;
    if (!held.factor(H)) break;
    x = held.minimise(H, h, F, x);
    const Sets next = next_sets(x, H * x + h, F, held.sets, 0.1 * tolerance);
    const int last_changes = changes;
    changes = differences(held.sets, next);
    result.finished = changes == 0;
    // Gives up if more than a quarter of the rows changes in the first iteration, or if the number
    // of changes does not fall: more iterations would rarely help.
    const bool far = result.factorisations == 1 && 4 * changes > static_cast<int>(x.size());
    if (far || changes >= last_changes) break;
    held.sets = next;
  }
  if (!result.finished) return result;
  // Two more proximal steps, each centred at the last answer, remove the error of the shift where S
  // is regular.
  for (int round = 0; round < 2; ++round) {
    result.x = x;
    x = held.minimise(H, qp.s - shift * x, F, x);
    if (next_sets(x, qp.gradient(x), F, held.sets, 0.1 * tolerance) != held.sets) break;
    result.x = x;
  }
  return result;
}

}  // namespace trocar::law
