#include "core/dense.hpp"

namespace trocar::core {

SymmetricEigen symmetric_eigen(const MatX& A)
{
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

VecX symmetric_eigenvalues(const MatX& A)
{
  return Eigen::SelfAdjointEigenSolver<MatX>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Vec3 symmetric_eigenvalues(const Mat3& A)
{
  return Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace trocar::core
