#pragma once

#include <functional>
#include <string>

#include "mesh/mesh.hpp"

namespace trocar::test {

/// What a structured test block looks like.
struct BlockShape
{
  int nx = 3, ny = 3, nz = 3;            ///< cells
  core::Vec3 size = core::Vec3::Ones();  ///< [m]
  double jitter = 0.0;                   ///< inner nodes moved by up to this part of a cell
  /// Cells left out (a void) by their middle.
  std::function<bool(const core::Vec3&)> hole = [](const core::Vec3&) { return false; };
  bool quadratic = false;  ///< with a node in the middle of every edge
  /// Moves every node, middles included: curves the edges of quadratic tets.
  std::function<core::Vec3(const core::Vec3&)> map{};
};

/// Box of cells in six tets each; groups as in meshes/structured_beam: volume "beam", surfaces
/// "x0" … "z1" (outer boundary).
mesh::Mesh block(const BlockShape& shape);

}  // namespace trocar::test
