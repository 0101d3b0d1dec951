#include "law/schur_complement.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"

namespace trocar::law {
namespace {

/// A row that starts above this share of its bound counts as slipping.
constexpr double near_bound = 0.8;

}  // namespace

RowSplit split_rows(const Problem& problem)
{
  RowSplit rows;
  std::vector<double> F;
  for (const Block& block : problem.blocks) {
    if (block.law.set == Law::Set::zero) {
      rows.bilateral.push_back(block.first);
      continue;
    }
    if (block.law.set == Law::Set::disc)
      rows.bounds.pairs.push_back(static_cast<int>(rows.box.size()));
    for (int row = block.first; row < block.end(); ++row) {
      rows.box.push_back(row);
      F.push_back(block.law.upper);
    }
  }
  rows.bounds.F = Eigen::Map<const VecX>(F.data(), static_cast<Eigen::Index>(F.size()));
  return rows;
}

MatX pseudo_inverse(const MatX& matrix, double cut)
{
  if (matrix.rows() == 0) return matrix;
  const core::SymmetricEigen eigen = core::symmetric_eigen(matrix);
  const double smallest = cut * eigen.values.tail<1>()[0];
  const VecX inverse = eigen.values.unaryExpr(
      [smallest](double value) { return value > smallest ? 1.0 / value : 0.0; });
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

SchurComplement::SchurComplement(const Problem& problem)
    : problem_(&problem),
      rows_(split_rows(problem)),
      W_bb_(problem.W(rows_.bilateral, rows_.bilateral)),
      start_(problem.start(rows_.box))
{
  for (int row : W_bb_.kept()) kept_.push_back(rows_.bilateral[static_cast<std::size_t>(row)]);
  const VecX& F = bounds().F;
  for (int i = 0; i < static_cast<int>(start_.size()); ++i)
    if (!bounds().of_pair(i) && std::abs(start_[i]) >= near_bound * F[i])
      start_[i] = std::copysign(F[i], start_[i]);
  for (int i : bounds().pairs) {
    const double length = start_.segment<2>(i).norm();
    if (length > 0.0 && length >= near_bound * F[i]) start_.segment<2>(i) *= F[i] / length;
  }
}

bool SchurComplement::bilateral_redundant() const
{
  return kept_.size() < rows_.bilateral.size();
}

void SchurComplement::eliminate()
{
  if (S_.size() > 0) return;
  S_ = problem_->W(rows_.box, rows_.box);
  s_ = problem_->g(rows_.box);
  if (kept_.empty()) return;
  const MatX Y = W_bb_.half_solve(problem_->W(kept_, rows_.box));
  S_.noalias() -= Y.transpose() * Y;
  s_ -= Y.transpose() * W_bb_.half_solve(problem_->g(kept_));
}

BoxQp SchurComplement::qp()
{
  eliminate();
  return {S_, s_, rows_.bounds};
}

int SchurComplement::box_rank()
{
  if (rows_.box.empty()) return 0;
  return PivotedCholesky(qp().S, problem_->W.diagonal()(rows_.box).maxCoeff()).rank();
}

std::optional<VecX> SchurComplement::all_slipping() const
{
  const VecX& F = bounds().F;
  const auto at_bound = (start_.cwiseAbs().array() >= F.array()).count();
  if (2 * at_bound < start_.size() || !bounds().pairs.empty()) return std::nullopt;
  VecX lambda_f = start_, delta;
  for (int attempt = 0; attempt < 2; ++attempt) {
    with_kept_rows(lambda_f, delta);
    bool settled = true;
    for (Eigen::Index i = 0; i < lambda_f.size(); ++i) {
      const double slip = -std::copysign(F[i], delta[rows_.box[static_cast<std::size_t>(i)]]);
      settled = settled && slip == lambda_f[i];
      lambda_f[i] = slip;
    }
    if (settled) return lambda_f;
  }
  return std::nullopt;
}

/// All multipliers, zero on redundant rows [N]. `delta` becomes their δ [m].
VecX SchurComplement::with_kept_rows(const VecX& lambda_f, VecX& delta) const
{
  VecX lambda = VecX::Zero(problem_->rows());
  lambda(rows_.box) = lambda_f;
  delta = problem_->W * lambda + problem_->g;
  // One solve and one step of iterative refinement: with unmerged crossings (`-insertion_merge 0`)
  // the condition number of W_bb is up to 1e9.
  for (int k = 0; k < 2 && !kept_.empty(); ++k) {
    lambda(kept_) -= W_bb_.solve(delta(kept_));
    delta = problem_->W * lambda + problem_->g;
  }
  return lambda;
}

VecX SchurComplement::expand(const VecX& lambda_f) const
{
  VecX delta;
  const VecX lambda = with_kept_rows(lambda_f, delta);
  if (!bilateral_redundant()) return lambda;
  VecX least = lambda;
  least(rows_.bilateral) = W_bb_.onto_range(lambda(rows_.bilateral));
  const double accurate = std::max(2.0 * kkt_residual(*problem_, lambda), 1e-12);
  return kkt_residual(*problem_, least) <= accurate ? least : lambda;
}

}  // namespace trocar::law
