#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "io/msh_file.hpp"

// Contents of a Gmsh file by physical group. Only msh_mesh.cpp uses them.
namespace trocar::io {

inline constexpr const char* msh_kinds[] = {"point", "curve", "surface", "volume"};

/// All physical groups of one dimension and one name, with their elements.
struct MshGroup
{
  std::string name;
  int tag;                                    ///< smallest tag of the groups
  std::vector<const MshFile::Block*> blocks;  ///< sorted by entity

  bool empty() const
  {
    return std::all_of(blocks.begin(), blocks.end(), [](const auto* b) { return b->tags.empty(); });
  }
};

/// The physical groups of a dimension in the order of their tags. A group without a name is called
/// KIND_TAG, for example volume_3. Adds a remark when groups share a name.
std::vector<MshGroup> msh_groups(const MshFile& file, int dim, std::vector<std::string>& remarks);

/// References to the tets of a file. They need little memory beside the file's data and the mesh.
struct MshTets
{
  struct Place
  {
    int block, index;
  };
  std::vector<const MshFile::Block*> blocks;
  std::vector<int> region;  ///< index of the volume, by block
  std::vector<Place> tets;
  std::size_t nodes_each;

  std::int64_t tag(const Place& at) const
  {
    return blocks[static_cast<std::size_t>(at.block)]->tags[static_cast<std::size_t>(at.index)];
  }
  const int* nodes(const Place& at) const  // in Gmsh's node order
  {
    return &blocks[static_cast<std::size_t>(at.block)]
                ->nodes[nodes_each * static_cast<std::size_t>(at.index)];
  }
  int region_of(const Place& at) const { return region[static_cast<std::size_t>(at.block)]; }
};

/// The tets of the volumes in the order of their tags; `nodes_each`: nodes of a tet. Failure (65)
/// when two tets share a tag or a tet is in two volumes.
MshTets msh_tets(const MshFile& file, const std::vector<MshGroup>& volumes, std::size_t nodes_each);

}  // namespace trocar::io
