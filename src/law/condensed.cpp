#include "law/condensed.hpp"

#include <algorithm>

namespace trocar::law {

RowSplit split_rows(const Problem& problem)
{
  RowSplit rows;
  for (int i = 0; i < static_cast<int>(problem.rows()); ++i)
    (problem.kind[static_cast<std::size_t>(i)] == RowKind::box ? rows.box : rows.bilateral)
        .push_back(i);
  return rows;
}

MatX pseudo_inverse(const MatX& matrix, double cut)
{
  if (matrix.rows() == 0) return matrix;
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(matrix);
  const double smallest = cut * eigen.eigenvalues().tail<1>()[0];
  const VecX inverse = eigen.eigenvalues().unaryExpr(
      [smallest](double value) { return value > smallest ? 1.0 / value : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

Condensed::Condensed(const Problem& problem) : problem_(&problem), rows_(split_rows(problem))
{
  const RankReveal reveal = reveal_rank(problem.W(rows_.bilateral, rows_.bilateral));
  bilateral_rank_ = reveal.rank;
  redundant_ = reveal.rank < static_cast<int>(rows_.bilateral.size());
  for (int row : reveal.rows) kept_.push_back(rows_.bilateral[static_cast<std::size_t>(row)]);
  S_ = problem.W(rows_.box, rows_.box);
  s_ = problem.g(rows_.box);
  if (!kept_.empty()) {
    W_kept_.compute(problem.W(kept_, kept_));
    const MatX W_bf = problem.W(kept_, rows_.box);
    const MatX Z = W_kept_.solve(W_bf);
    S_ -= W_bf.transpose() * Z;
    S_ = 0.5 * (S_ + S_.transpose()).eval();
    s_ -= Z.transpose() * problem.g(kept_);
  }
  bound_ = problem.bound(rows_.box);
  if (!rows_.box.empty()) box_scale_ = problem.W.diagonal()(rows_.box).maxCoeff();
  start_ = problem.start(rows_.box).cwiseMax(-bound_).cwiseMin(bound_);
}

VecX Condensed::bilateral(const VecX& lambda_f) const
{
  const VecX rhs = -(problem_->g(kept_) + problem_->W(kept_, rows_.box) * lambda_f);
  VecX lambda = W_kept_.solve(rhs);
  // One step of iterative refinement: W_bb of raw crossings has condition numbers up to 1e9.
  lambda += W_kept_.solve(rhs - problem_->W(kept_, kept_) * lambda);
  return lambda;
}

VecX Condensed::expand(const VecX& lambda_f) const
{
  VecX lambda = VecX::Zero(problem_->rows());
  lambda(rows_.box) = lambda_f;
  if (!kept_.empty()) lambda(kept_) = bilateral(lambda_f);
  if (!redundant_) return lambda;
  const MatX W_bb = problem_->W(rows_.bilateral, rows_.bilateral);
  VecX least = lambda;
  least(rows_.bilateral) = pseudo_inverse(W_bb, 1e-10) * (W_bb * lambda(rows_.bilateral));
  const double accurate = std::max(2.0 * kkt_residual(*problem_, lambda), 1e-12);
  return kkt_residual(*problem_, least) <= accurate ? least : lambda;
}

}  // namespace trocar::law
