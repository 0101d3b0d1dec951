#include "base/blas.hpp"

#include <petscsys.h>
// after petscsys.h, on which it leans
#include <petscblaslapack.h>

#include <algorithm>
#include <vector>

#include "core/stopwatch.hpp"

namespace trocar::base {

double blas_rate()
{
  constexpr PetscBLASInt n = 384;
  constexpr int repeats = 5;
  const std::vector<double> a(n * n, 1.0), b(n * n, 0.5);
  std::vector<double> c(n * n, 0.0);
  const double one = 1.0, zero = 0.0;
  double best = 0.0;
  for (int k = 0; k < repeats; ++k) {
    const core::Stopwatch watch;
    BLASgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
    best = std::max(best, 2.0 * n * n * n / std::max(watch.seconds(), 1e-9));
  }
  return best;
}

}  // namespace trocar::base
