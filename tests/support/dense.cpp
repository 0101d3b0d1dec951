#include "support/dense.hpp"

namespace trocar::test {

core::MatX inverse(const core::MatX& A)
{
  return A.inverse();
}

core::MatX solved(const core::MatX& A, const core::MatX& B)
{
  return A.partialPivLu().solve(B);
}

}  // namespace trocar::test
