#pragma once

#include <array>
#include <span>

#include "mesh/mesh.hpp"
#include "tissue/element_blocks.hpp"

namespace trocar::test {

/// K turned by R plus 1e3 M of a tet; transposed as the slots say.
template <int N>
fem::ElementBlocks<N> blocks_of(const mesh::Mesh& mesh, int tet, const core::Mat3& R,
                                std::span<const int> slots)
{
  const tissue::Material m;
  const auto shapes = fem::point_shapes<N>(mesh, tet);
  std::array<core::Mat3, fem::points_per_tet<N>> turns;
  turns.fill(R);
  Eigen::Matrix<double, N, N> mass = Eigen::Matrix<double, N, N>::Constant(0.05);
  mass.diagonal() *= 2.0;
  return tissue::operator_blocks<N>(m.lambda(), m.mu(), shapes.data(), turns.data(),
                                    mesh::tet_volume(mesh, tet) * mass, 1e3 * m.density, slots);
}

}  // namespace trocar::test
