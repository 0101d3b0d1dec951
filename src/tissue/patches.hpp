#pragma once

#include <array>
#include <vector>

#include "fem/block_matrix.hpp"

namespace trocar::tissue {

/// A corner node with the tets of one volume around it: where a nodal dilatation is averaged,
/// θ_v = Σ_q V_q N_v(q) θ_q / M_v with M_v = Σ_q V_q N_v(q).
struct Patches
{
  /// Of every corner of every local tet; -1 when the tets around it are not all local, which is so
  /// only for tets that touch no node owned here.
  std::vector<std::array<int, 4>> of_tet;
  std::vector<double> measure;     ///< M_v [m³]
  std::vector<int> region;         ///< volume of the mesh
  std::vector<std::size_t> start;  ///< of the members
  struct Member
  {
    std::size_t tet;
    int corner;
  };
  std::vector<Member> member;

  std::size_t size() const { return region.size(); }
};

/// The patches of a space with two rings; measures are left 0. `region` by local tet.
Patches corner_patches(const fem::Space& space, const std::vector<int>& region);

/// The nodes of every patch.
fem::Cliques patch_nodes(const Patches& patches, const fem::Space& space);

}  // namespace trocar::tissue
