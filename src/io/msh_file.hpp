#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::io {

/// The mesh data of a Gmsh file, before any check of the mesh itself. A value type.
struct MshFile
{
  /// A physical group. `name` is empty when the file gives none.
  struct Group
  {
    int dim, tag;
    std::string name;
  };
  /// Elements of one type on one entity, and the physical groups that contain them.
  struct Block
  {
    int type;  ///< Gmsh's number of the element type
    int dim, entity;
    std::vector<int> groups;         ///< tags of the physical groups
    std::vector<std::int64_t> tags;  ///< tags of the elements
    std::vector<int> nodes;          ///< indices into `node_tag`, in Gmsh's node order
  };

  std::string file;
  std::string hash;                    ///< FNV-1a of the file's bytes
  std::vector<Group> groups;           ///< sorted by dimension, then by tag
  std::vector<std::int64_t> node_tag;  ///< tags of the nodes, distinct and positive
  std::vector<double> x;               ///< coordinates, 3 per node, finite, in the file's unit
  std::vector<Block> blocks;           ///< of elements in at least one physical group
  std::int64_t loose_tets = 0;         ///< number of tets in no physical group
};

/// Reads MSH 2.2 and 4.1, ascii and binary. Skips sections that do not describe the mesh. Failure
/// (65) for partitioned files, other versions and malformed contents; its one line names the line
/// or byte. Executes nothing and opens no other file. Call on one rank only.
MshFile read_msh(const std::string& file);

}  // namespace trocar::io
