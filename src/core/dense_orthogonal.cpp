#include "core/dense.hpp"

// The orthogonal factorisations have a file of their own, because they take longest to compile.
namespace trocar::core {

VecX least_squares(const MatX& A, const VecX& b)
{
  return A.completeOrthogonalDecomposition().solve(b);
}

VecX project_onto_range(const MatX& L, const VecX& x)
{
  const Eigen::HouseholderQR<MatX> qr(L);
  VecX y = qr.householderQ().adjoint() * x;
  y.tail(y.size() - L.cols()).setZero();
  return qr.householderQ() * y;
}

}  // namespace trocar::core
