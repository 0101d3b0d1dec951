#include "core/dense.hpp"

namespace trocar::core {
namespace {

template <class Columns>
void solve_in_place(const MatX& L, Columns& b)
{
  if (b.size() == 0) return;  // Eigen would refer to a first entry that is not there
  L.triangularView<Eigen::Lower>().solveInPlace(b);
  L.triangularView<Eigen::Lower>().transpose().solveInPlace(b);
}

}  // namespace

void Cholesky::compute(MatX A)
{
  L_ = std::move(A);
  regular_ = cholesky_in_place(L_);
}

VecX Cholesky::solve(const VecX& b) const
{
  VecX x = b;
  solve_in_place(L_, x);
  return x;
}

MatX Cholesky::solve(const MatX& B) const
{
  MatX X = B;
  solve_in_place(L_, X);
  return X;
}

bool cholesky_in_place(MatX& A)
{
  return Eigen::LLT<Eigen::Ref<MatX>>(A).info() == Eigen::Success;
}

Square::Square(const MatX& A) : lu_(A) {}

VecX Square::solve(const VecX& b) const
{
  return lu_.solve(b);
}

}  // namespace trocar::core
