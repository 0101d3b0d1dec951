#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::io {

/// What a Gmsh file holds of a mesh, not yet judged. A value.
struct MshFile
{
  /// A physical group with the name the file gives it, or none.
  struct Group
  {
    int dim, tag;
    std::string name;
  };
  /// Elements of one type on one entity, and the physical groups they are in.
  struct Block
  {
    int type;  ///< as Gmsh numbers them
    int dim, entity;
    std::vector<int> groups;         ///< tags
    std::vector<std::int64_t> tags;  ///< of the elements
    std::vector<int> nodes;          ///< rows of `node_tag`, in Gmsh's order
  };

  std::string file;
  std::string hash;                    ///< FNV-1a of its bytes
  std::vector<Group> groups;           ///< ascending by dimension and tag
  std::vector<std::int64_t> node_tag;  ///< distinct, positive
  std::vector<double> x;               ///< 3 by node, finite, in the file's unit
  std::vector<Block> blocks;           ///< of elements in some group
  std::int64_t loose_tets = 0;         ///< tets in no group
};

/// Reads MSH 2.2 and 4.1, ascii and binary. Sections that are not about the mesh itself are
/// skipped; partitioned files and other versions are refused. Failure (65), one line that names the
/// line or byte, for whatever else is in the file. Runs nothing and looks at no other file. For one
/// rank alone.
MshFile read_msh(const std::string& file);

}  // namespace trocar::io
