#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

using Triangle = std::array<Vec3, 3>;

/// The closed surface of a rigid body, its triangles seen from outside in the positive sense.
struct Skin
{
  std::vector<Vec3> x;  ///< corners [m]
  std::vector<Face> faces;

  Triangle triangle(std::size_t f) const;
  double volume() const;  ///< inside [m³]
};

/// The surface of triangles whose corners are equal where they meet. Throws Failure (65) naming the
/// file unless it is closed, simple along its edges, and right side out.
Skin skin_of(const std::vector<Triangle>& triangles, const std::string& file);

}  // namespace trocar::mesh
