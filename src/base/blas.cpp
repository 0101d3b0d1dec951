#include "base/blas.hpp"

#include <petscsys.h>
// must come after petscsys.h, which it needs
#include <petscblaslapack.h>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/stopwatch.hpp"

namespace trocar::base {
namespace {

constexpr double one = 1.0, zero = 0.0;

PetscBLASInt integer(Eigen::Index n)
{
  return static_cast<PetscBLASInt>(n);
}

/// Leading dimension for the BLAS, which demands at least 1 even for an empty block.
PetscBLASInt stride(Eigen::Index n)
{
  return static_cast<PetscBLASInt>(std::max<Eigen::Index>(n, 1));
}

}  // namespace

MatX product(const Block& A, const MatX& B)
{
  MatX C(A.rows(), B.cols());
  if (C.size() == 0) return C;
  const PetscBLASInt m = integer(A.rows()), n = integer(B.cols()), k = integer(A.cols());
  const PetscBLASInt lda = stride(A.outerStride()), ldb = stride(B.rows()), ldc = stride(m);
  BLASgemm_("N", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &zero, C.data(), &ldc);
  return C;
}

MatX transposed_product(const MatX& A, const Block& B)
{
  MatX C(A.cols(), B.cols());
  if (C.size() == 0) return C;
  const PetscBLASInt m = integer(A.cols()), n = integer(B.cols()), k = integer(A.rows());
  const PetscBLASInt lda = stride(A.rows()), ldb = stride(B.outerStride()), ldc = stride(m);
  BLASgemm_("T", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &zero, C.data(), &ldc);
  return C;
}

void add_gram(const MatX& A, Part C)
{
  if (C.size() == 0) return;
  const PetscBLASInt n = integer(A.cols()), k = integer(A.rows());
  const PetscBLASInt lda = stride(A.rows()), ldc = stride(C.outerStride());
  BLASsyrk_("L", "T", &n, &k, &one, A.data(), &lda, &one, C.data(), &ldc);
}

MatX gram(const MatX& A)
{
  MatX C = MatX::Zero(A.cols(), A.cols());
  add_gram(A, C);
  C.triangularView<Eigen::StrictlyUpper>() = C.transpose();
  return C;
}

void subtract_product(const Block& A, const Block& B, Part C)
{
  if (C.size() == 0) return;
  const double minus = -1.0;
  const PetscBLASInt m = integer(A.rows()), n = integer(B.cols()), k = integer(A.cols());
  const PetscBLASInt lda = stride(A.outerStride()), ldb = stride(B.outerStride());
  const PetscBLASInt ldc = stride(C.outerStride());
  BLASgemm_("N", "N", &m, &n, &k, &minus, A.data(), &lda, B.data(), &ldb, &one, C.data(), &ldc);
}

void solve_lower(const Block& L, Part B)
{
  if (B.size() == 0) return;
  const PetscBLASInt m = integer(B.rows()), n = integer(B.cols());
  const PetscBLASInt ldl = stride(L.outerStride()), ldb = stride(B.outerStride());
  BLAStrsm_("L", "L", "N", "N", &m, &n, &one, L.data(), &ldl, B.data(), &ldb);
}

double blas_rate()
{
  constexpr PetscBLASInt n = 384;
  constexpr int repeats = 5;
  const std::vector<double> a(n * n, 1.0), b(n * n, 0.5);
  std::vector<double> c(n * n, 0.0);
  double best = 0.0;
  for (int k = 0; k < repeats; ++k) {
    const core::ProcessorStopwatch watch;
    BLASgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
    best = std::max(best, 2.0 * n * n * n / std::max(watch.seconds(), 1e-9));
  }
  return best;
}

std::string blas_library()
{
  Dl_info found{};
  void* product = dlsym(RTLD_DEFAULT, "dgemm_");
  if (!product || dladdr(product, &found) == 0 || !found.dli_fname) return {};
  const std::unique_ptr<char, decltype(&std::free)> file(realpath(found.dli_fname, nullptr),
                                                         &std::free);
  return file ? file.get() : found.dli_fname;
}

bool slow_blas(double rate, const std::string& library)
{
  constexpr double sensible = 8e9;  // reference BLAS does 6 Gflop/s, OpenBLAS 40 to 110
  const auto named = [&](const char* name) { return library.find(name) != std::string::npos; };
  constexpr std::array fast{"openblas", "mkl", "blis", "armpl", "libsci"};
  return rate < sensible && std::none_of(fast.begin(), fast.end(), named);
}

}  // namespace trocar::base
