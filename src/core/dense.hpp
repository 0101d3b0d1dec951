#pragma once

#include <utility>

#include "core/math.hpp"

// Dense factorisations of matrices of any size. Only dense*.cpp instantiate them, because each one
// adds seconds to the compilation of a file.
namespace trocar::core {

/// A = L Lᵀ of a symmetric positive definite matrix; only the lower half of A is read.
class Cholesky
{
 public:
  Cholesky() = default;
  explicit Cholesky(MatX A) { compute(std::move(A)); }

  void compute(MatX A);
  /// False when a pivot was not positive; then `solve` must not be called.
  bool regular() const { return regular_; }
  /// A⁻¹ b; b and the result have the rows of A.
  VecX solve(const VecX& b) const;
  MatX solve(const MatX& B) const;

 private:
  MatX L_;  ///< L in the lower half
  bool regular_ = false;
};

/// A⁻¹ b of a regular square matrix (LU with partial pivoting).
class Square
{
 public:
  Square() = default;
  explicit Square(const MatX& A);
  VecX solve(const VecX& b) const;

 private:
  Eigen::PartialPivLU<MatX> lu_;
};

/// Overwrites the lower half of A with the L of A = L Lᵀ. Returns false when a pivot is not
/// positive.
bool cholesky_in_place(MatX& A);

/// The x of least norm among all x that minimise |A x - b|, for any A (complete orthogonal
/// decomposition).
VecX least_squares(const MatX& A, const VecX& b);

/// Eigenvalues of a symmetric matrix, ascending, and its unit eigenvectors, one per column.
struct SymmetricEigen
{
  VecX values;
  MatX vectors;
};
SymmetricEigen symmetric_eigen(const MatX& A);
/// Eigenvalues of a symmetric matrix, ascending.
VecX symmetric_eigenvalues(const MatX& A);
Vec3 symmetric_eigenvalues(const Mat3& A);

/// Orthogonal projection of x onto the range of L (n x r, of full rank r).
VecX project_onto_range(const MatX& L, const VecX& x);

}  // namespace trocar::core
