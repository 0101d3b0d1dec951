#pragma once

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Leaves one of several tets with the same four corners and says so; in different volumes they are
/// a Failure (65).
void drop_repeated(Mesh& mesh);

/// Whether valid tets make a body: what cannot be one is a Failure (65) with the tags, what its
/// user should know is added to `remarks`. Refused are a face with three tets, two tets on one side
/// of a face, and tets of one connected part that overlap. Triangles of surfaces that are no face
/// of a tet become strays, those listed twice count once. Nearly linear in the tets.
void judge(Mesh& mesh);

/// How tets overlap that have a face on the boundary: wherever tets of a body whose faces match do,
/// some of these do as well.
struct Overlap
{
  std::array<int, 2> tets{-1, -1};  ///< of one connected part
  long long between_parts = 0;      ///< pairs of tets of different parts
  double depth = 0.0;               ///< the deepest of these [m]
  bool whole = true;                ///< false: too many tets at one place to look at all pairs
};
/// `boundary`: tets with a face there; `part`: of the nodes.
Overlap find_overlap(const Mesh& mesh, const std::vector<int>& boundary,
                     const std::vector<int>& part);

/// By how much two tets would have to be moved apart, 0 where they do not overlap [m].
double overlap_depth(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b);

}  // namespace trocar::mesh
