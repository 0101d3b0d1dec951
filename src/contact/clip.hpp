#pragma once

#include <array>
#include <vector>

#include "core/math.hpp"

namespace trocar::contact {

using core::Vec3;
using Triangle = std::array<Vec3, 3>;

/// A triangle in which two triangles overlap: the barycentric coordinates of its corners in the
/// slave and in the master triangle, and its area on the slave's plane [m²].
struct Overlap
{
  Eigen::Matrix3d slave, master;  ///< one corner a column
  double area;
};

/// Overlap of the master triangle, seen along the slave's normal, with the slave triangle
/// (Sutherland and Hodgman 1974; the polygon as a fan). Empty when they face the same way
/// (n·n' > -0.2), when all corners of the master are farther than `search` [m] from the slave's
/// plane on one side, or for pieces below 1e-14 of the slave's area.
std::vector<Overlap> overlap(const Triangle& slave, const Triangle& master, double search);

}  // namespace trocar::contact
