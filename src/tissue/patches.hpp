#pragma once

#include <array>
#include <vector>

#include "fem/block_matrix.hpp"

namespace trocar::tissue {

/// The patches over which a nodal dilatation is averaged. A patch v is a corner node with the tets
/// of one volume of the mesh around it: θ_v = Σ_q V_q N_v(q) θ_q / M_v with M_v = Σ_q V_q N_v(q).
struct Patches
{
  /// Patch of every corner of every local tet. -1: some tets around the corner may not be local.
  /// This happens only in tets that touch no owned node.
  std::vector<std::array<int, 4>> of_tet;
  std::vector<double> measure;     ///< M_v by patch [m³]
  std::vector<int> region;         ///< volume of the mesh, by patch
  std::vector<std::size_t> start;  ///< where the members of a patch begin in `member`
  struct Member
  {
    std::size_t tet;
    int corner;
  };
  std::vector<Member> member;

  std::size_t size() const { return region.size(); }
};

/// The patches of a space with two overlap layers, all measures still 0. `region`: volume of the
/// mesh, by local tet.
Patches corner_patches(const fem::Space& space, const std::vector<int>& region);

/// The nodes of all tets of every patch.
fem::Cliques patch_nodes(const Patches& patches, const fem::Space& space);

}  // namespace trocar::tissue
