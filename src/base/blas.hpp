#pragma once

#include <string>

#include "core/math.hpp"

namespace trocar::base {

using core::MatX;
using Block = Eigen::Map<const MatX, 0, Eigen::OuterStride<>>;  ///< columns of a larger array
using Part = Eigen::Ref<MatX, 0, Eigen::OuterStride<>>;         ///< the same, to be written to

/// Products and solves of large dense blocks by the BLAS that the program is linked with.
MatX product(const Block& A, const MatX& B);                    ///< A B
MatX transposed_product(const MatX& A, const Block& B);         ///< Aᵀ B
void subtract_product(const Block& A, const Block& B, Part C);  ///< C -= A B
/// C += Aᵀ A on the lower triangle of a block of a larger array.
void add_gram(const MatX& A, Part C);
MatX gram(const MatX& A);                  ///< Aᵀ A, both triangles
void solve_lower(const Block& L, Part B);  ///< B <- L⁻¹ B, L lower triangular

/// Speed of this process's dense matrix product [flop/s], by processor time: the best of a few
/// products of 384 x 384, some milliseconds in all. Factor and compliance columns run at this speed
/// where nobody else wants the processor.
double blas_rate();

/// File of the library whose matrix product this process calls, links followed; "" when it is not
/// in one.
std::string blas_library();

/// A library does less than 8 Gflop/s and is none of those known to be fast: these are held up by
/// other processes that share a core or its clock.
bool slow_blas(double rate, const std::string& library);

}  // namespace trocar::base
