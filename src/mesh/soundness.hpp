#pragma once

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Keeps one of several tets with the same four corners and adds a remark. Failure (65) where such
/// tets are in different volumes.
void drop_repeated(Mesh& mesh);

/// Checks whether valid tets make a body. Failure (65) with the tags for a face with more than two
/// tets, two tets on the same side of a face, or overlapping tets of one connected part. Other
/// findings are added to `remarks`. Surface triangles that are no face of a tet become strays. A
/// triangle that is listed twice counts once. The cost is nearly linear in the number of tets.
void judge(Mesh& mesh);

/// Overlaps among boundary tets, which are tets with a face on the boundary. Testing boundary tets
/// is enough: if any two tets of a body with matching faces overlap, two boundary tets overlap too.
struct Overlap
{
  std::array<int, 2> tets{-1, -1};  ///< overlapping pair in one connected part; -1: none
  long long between_parts = 0;      ///< overlapping pairs of tets in different parts
  double depth = 0.0;               ///< largest overlap between different parts [m]
  bool whole = true;                ///< false: too many pairs, not all were tested
};
/// `boundary`: tets with a face on the boundary; `part`: connected part of every node.
Overlap find_overlap(const Mesh& mesh, const std::vector<int>& boundary,
                     const std::vector<int>& part);

/// Length of the shortest translation that separates two straight tets [m]; 0 without overlap.
double overlap_depth(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b);

}  // namespace trocar::mesh
