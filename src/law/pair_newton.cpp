#include <algorithm>
#include <cmath>
#include <vector>

#include "core/dense.hpp"
#include "law/box_qp.hpp"

namespace trocar::law {
namespace {

/// State of every row and pair: free, or on its bound. A pair that slips is turned: its first row
/// becomes the direction along its force, which is held, its second row the direction across, which
/// is free.
struct Slip
{
  /// By row: 0 free, -1 or 1 on that bound. A pair that slips has 1 in its first row.
  std::vector<signed char> state;
  std::vector<Eigen::Vector2d> along;  ///< by pair: unit vector of its force, zero where it sticks
  VecX target;                         ///< values of held rows, in turned directions (rows) [N]
  VecX stiffness;                      ///< added to the diagonal of free rows (rows, turned) [m/N]
  VecX pull;                           ///< factor on the gradient of free rows (rows, turned)
};

Slip slip_at(const Bounds& bounds, const VecX& y, const VecX& w)
{
  const Eigen::Index n = y.size();
  Slip slip{std::vector<signed char>(static_cast<std::size_t>(n), 0),
            std::vector<Eigen::Vector2d>(bounds.pairs.size(), Eigen::Vector2d::Zero()),
            VecX::Zero(n), VecX::Zero(n), VecX::Ones(n)};
  for (int i = 0; i < static_cast<int>(n); ++i) {
    if (bounds.of_pair(i) || std::abs(y[i]) <= bounds.F[i]) continue;
    slip.state[static_cast<std::size_t>(i)] = y[i] > 0.0 ? 1 : -1;
    slip.target[i] = std::copysign(bounds.F[i], y[i]);
  }
  for (std::size_t k = 0; k < bounds.pairs.size(); ++k) {
    const int i = bounds.pairs[k];
    const double length = y.segment<2>(i).norm(), F = bounds.F[i];
    if (!(F > 0.0)) {  // both multipliers are zero
      slip.state[static_cast<std::size_t>(i)] = slip.state[static_cast<std::size_t>(i) + 1] = 1;
      continue;
    }
    if (length <= F) continue;
    slip.state[static_cast<std::size_t>(i)] = 1;
    slip.along[k] = y.segment<2>(i) / length;
    slip.target[i] = F;
    slip.stiffness[i + 1] = w[i] * (length - F) / F;
    slip.pull[i + 1] = length / F;
  }
  return slip;
}

/// Turns the rows (i, i+1) of A into along and across, for every pair that slips.
void turn_rows(const Bounds& bounds, const Slip& slip, MatX& A)
{
  for (std::size_t k = 0; k < bounds.pairs.size(); ++k) {
    const Eigen::Vector2d e = slip.along[k];
    if (e.isZero(0.0)) continue;
    const int i = bounds.pairs[k];
    const Eigen::RowVectorXd first = A.row(i), second = A.row(i + 1);
    A.row(i) = e.x() * first + e.y() * second;
    A.row(i + 1) = -e.y() * first + e.x() * second;
  }
}

VecX turned(const Bounds& bounds, const Slip& slip, const VecX& x)
{
  MatX column = x;
  turn_rows(bounds, slip, column);
  return column;
}

VecX turned_back(const Bounds& bounds, const Slip& slip, VecX x)
{
  for (std::size_t k = 0; k < bounds.pairs.size(); ++k) {
    const Eigen::Vector2d e = slip.along[k];
    if (e.isZero(0.0)) continue;
    const int i = bounds.pairs[k];
    const double along = x[i], across = x[i + 1];
    x[i] = e.x() * along - e.y() * across;
    x[i + 1] = e.y() * along + e.x() * across;
  }
  return x;
}

/// Newton's step from x in the given states. Returns false when a pivot is not positive.
bool step(const MatX& H, const VecX& gradient, const Bounds& bounds, const Slip& slip, VecX& x)
{
  MatX A = H;
  turn_rows(bounds, slip, A);
  MatX transposed = A.transpose();
  turn_rows(bounds, slip, transposed);
  A = transposed.transpose();
  A.diagonal() += slip.stiffness;
  const VecX g = turned(bounds, slip, gradient), here = turned(bounds, slip, x);
  std::vector<int> free;
  VecX change = VecX::Zero(x.size());
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    if (slip.state[static_cast<std::size_t>(i)] == 0)
      free.push_back(i);
    else
      change[i] = slip.target[i] - here[i];
  }
  if (!free.empty()) {
    const VecX rhs = -(slip.pull.cwiseProduct(g) + A * change)(free);
    const core::Cholesky factor(A(free, free));
    if (!factor.regular()) return false;
    change(free) = factor.solve(rhs);
  }
  x += turned_back(bounds, slip, change);
  return true;
}

}  // namespace

BoxSolution pair_newton(const BoxQp& qp, const VecX& start, double tolerance, int max_iterations)
{
  const Bounds& bounds = qp.bounds;
  constexpr int most_stalls = 3;
  const double shift = 0.1 * tolerance / std::max(bounds.F.maxCoeff(), 1e-300);
  MatX H = qp.S;
  H.diagonal().array() += shift;
  const VecX w = bounds.mean_diagonal(qp.S);
  BoxSolution result{start, 0, false};
  VecX x = bounds.clip(start);
  std::vector<signed char> last;
  auto fewest = x.size() + 1;
  int stalls = 0;
  while (result.factorisations < max_iterations) {
    const VecX gradient = qp.gradient(x);
    const Slip slip = slip_at(bounds, x - gradient.cwiseQuotient(w), w);
    if (!last.empty()) {
      Eigen::Index changed = 0;
      for (std::size_t i = 0; i < last.size(); ++i) changed += last[i] != slip.state[i] ? 1 : 0;
      stalls = changed > 0 && changed >= fewest ? stalls + 1 : 0;
      fewest = std::min(fewest, changed);
      if (stalls >= most_stalls) break;
    }
    last = slip.state;
    ++result.factorisations;
    if (!step(H, gradient, bounds, slip, x) || !x.allFinite()) break;
    // Clipped, so that a row or pair that slips lies exactly on its bound.
    const VecX on = bounds.clip(x);
    if (box_residual(qp, on) > 0.1 * tolerance) continue;
    result.finished = true;
    result.x = on;
    break;
  }
  return result;
}

}  // namespace trocar::law
