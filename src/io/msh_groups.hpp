#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "io/msh_file.hpp"

// What a Gmsh file has by physical group: for msh_mesh.cpp alone.
namespace trocar::io {

inline constexpr const char* msh_kinds[] = {"point", "curve", "surface", "volume"};

/// Physical groups of one name, and what is in them.
struct MshGroup
{
  std::string name;
  int tag;                                    ///< the least of them
  std::vector<const MshFile::Block*> blocks;  ///< ascending by entity

  bool empty() const
  {
    return std::all_of(blocks.begin(), blocks.end(), [](const auto* b) { return b->tags.empty(); });
  }
};

/// Those of a dimension in the order of their tags; of one without a name kind and tag make it.
std::vector<MshGroup> msh_groups(const MshFile& file, int dim, std::vector<std::string>& remarks);

/// The tets of the file, by place, so that they take little memory beside it and the mesh.
struct MshTets
{
  struct Place
  {
    int block, index;
  };
  std::vector<const MshFile::Block*> blocks;
  std::vector<int> region;  ///< by block
  std::vector<Place> tets;
  std::size_t nodes_each;

  std::int64_t tag(const Place& at) const
  {
    return blocks[static_cast<std::size_t>(at.block)]->tags[static_cast<std::size_t>(at.index)];
  }
  const int* nodes(const Place& at) const  // in Gmsh's order
  {
    return &blocks[static_cast<std::size_t>(at.block)]
                ->nodes[nodes_each * static_cast<std::size_t>(at.index)];
  }
  int region_of(const Place& at) const { return region[static_cast<std::size_t>(at.block)]; }
};

/// The tets of volumes by ascending tag, with so many nodes each. Failure (65) where a tag means
/// two of them.
MshTets msh_tets(const MshFile& file, const std::vector<MshGroup>& volumes, std::size_t nodes_each);

}  // namespace trocar::io
