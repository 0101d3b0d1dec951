#include "solve/interface_block.hpp"

#include "base/blas.hpp"
#include "core/dense.hpp"
#include "core/failure.hpp"

namespace trocar::solve {

void InterfaceBlock::factorise(core::MatX S)
{
  L_ = std::move(S);
  if (!core::cholesky_in_place(L_) || !L_.diagonal().allFinite())
    throw core::solver_error(
        "the tissue's operator is not positive definite: a body without supports (-fix), or "
        "elements that are nearly flat");
  forget_columns();
}

core::VecX InterfaceBlock::forward(const core::VecX& t) const
{
  return L_.triangularView<Eigen::Lower>().solve(t);
}

core::VecX InterfaceBlock::backward(const core::VecX& y) const
{
  return L_.triangularView<Eigen::Lower>().transpose().solve(y);
}

void InterfaceBlock::add(const core::MatX& t)
{
  core::MatX columns = t;
  base::solve_lower({L_.data(), L_.rows(), L_.cols(), Eigen::OuterStride<>(L_.rows())}, columns);
  const Eigen::Index before = X_.cols();
  X_.conservativeResize(L_.rows(), before + t.cols());
  X_.rightCols(t.cols()) = columns;
}

core::MatX InterfaceBlock::block(const std::vector<int>& slots) const
{
  return base::gram(X_(Eigen::all, slots));
}

}  // namespace trocar::solve
