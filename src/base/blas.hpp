#pragma once

#include <string>

#include "core/math.hpp"

namespace trocar::base {

using core::MatX;
using Block = Eigen::Map<const MatX, 0, Eigen::OuterStride<>>;  ///< block of a larger array
using Part = Eigen::Ref<MatX, 0, Eigen::OuterStride<>>;  ///< writable block of a larger array

/// Products and solves of large dense blocks by the BLAS that the program is linked with.
MatX product(const Block& A, const MatX& B);                    ///< A B
MatX transposed_product(const MatX& A, const Block& B);         ///< Aᵀ B
void subtract_product(const Block& A, const Block& B, Part C);  ///< C -= A B
/// C += Aᵀ A, in the lower triangle of C only.
void add_gram(const MatX& A, Part C);
MatX gram(const MatX& A);                  ///< Aᵀ A, both triangles
void solve_lower(const Block& L, Part B);  ///< B <- L⁻¹ B, L lower triangular

/// Speed of dense matrix products in this process [flop/s]: the best of five products of 384 x 384
/// matrices, measured in processor time. Takes some milliseconds. Factorisations and compliance
/// columns run at this speed when no other process uses the processor.
double blas_rate();

/// Path of the library file that provides this process's `dgemm`, with symbolic links resolved.
/// Empty when it is not found.
std::string blas_library();

/// True when `rate` is below 8 Gflop/s and the library is not known to be fast. A library known to
/// be fast is that slow only when other processes share its core or clock.
bool slow_blas(double rate, const std::string& library);

}  // namespace trocar::base
