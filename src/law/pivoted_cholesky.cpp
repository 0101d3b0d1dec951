#include "law/pivoted_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/dense.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

// Right-looking, in panels of columns. A column is updated with the columns of its own panel only.
// After each panel, one matrix product updates the rest of the matrix.
PivotedCholesky::PivotedCholesky(MatX matrix, double scale, double cut)
    : factor_(std::move(matrix)), order_(static_cast<std::size_t>(factor_.rows()))
{
  constexpr Eigen::Index panel = 32;
  const Eigen::Index n = factor_.rows();
  std::iota(order_.begin(), order_.end(), 0);
  if (n == 0) return;
  VecX left = factor_.diagonal();
  const double stop = cut * (scale > 0.0 ? scale : left.maxCoeff());
  for (Eigen::Index k = 0, begin = 0; k < n; ++k) {
    if (k == begin + panel) {
      const auto done = factor_.block(k, begin, n - k, panel);
      factor_.bottomRightCorner(n - k, n - k).noalias() -= done * done.transpose();
      begin = k;
    }
    Eigen::Index pivot = 0;
    if (!(left.tail(n - k).maxCoeff(&pivot) > stop)) break;
    pivot += k;
    std::swap(order_[static_cast<std::size_t>(k)], order_[static_cast<std::size_t>(pivot)]);
    std::swap(left[k], left[pivot]);
    factor_.row(k).swap(factor_.row(pivot));
    factor_.col(k).tail(n - k).swap(factor_.col(pivot).tail(n - k));
    const Eigen::Index rest = n - k - 1, made = k - begin;
    const double root = std::sqrt(left[k]);
    factor_(k, k) = root;
    auto column = factor_.col(k).tail(rest);
    column.noalias() -=
        factor_.block(k + 1, begin, rest, made) * factor_.row(k).segment(begin, made).transpose();
    column /= root;
    left.tail(rest) -= column.cwiseAbs2();
    ++rank_;
  }
}

MatX PivotedCholesky::half_solve(MatX b) const
{
  factor_.topLeftCorner(rank_, rank_).triangularView<Eigen::Lower>().solveInPlace(b);
  return b;
}

VecX PivotedCholesky::solve(VecX b) const
{
  const auto L = factor_.topLeftCorner(rank_, rank_).triangularView<Eigen::Lower>();
  L.solveInPlace(b);
  L.transpose().solveInPlace(b);
  return b;
}

VecX PivotedCholesky::onto_range(const VecX& x) const
{
  const MatX L = factor_.leftCols(rank_).triangularView<Eigen::Lower>();
  VecX result(x.size());
  result(order_) = core::project_onto_range(L, x(order_));
  return result;
}

double PivotedCholesky::condition() const
{
  if (rank_ == 0) return 0.0;
  const double ratio = factor_(0, 0) / factor_(rank_ - 1, rank_ - 1);
  return ratio * ratio;
}

}  // namespace trocar::law
