#pragma once

#include "core/math.hpp"

// Dense references, compiled once.
namespace trocar::test {

core::MatX inverse(const core::MatX& A);
/// A⁻¹ B.
core::MatX solved(const core::MatX& A, const core::MatX& B);

}  // namespace trocar::test
