#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/msh_file.hpp"
#include "io/msh_input.hpp"

// The sections of a Gmsh file: for msh_file.cpp alone.
namespace trocar::io {

inline constexpr const char* partitioned =
    "the mesh is partitioned: save it whole (the program divides it itself)";

struct MshFormat
{
  bool four = false;  ///< 4.1, else 2.2
  bool binary = false;
};

/// Dimension and nodes of an element type.
struct MshType
{
  int dim, nodes;
};
/// Failure (65) for a number that is no type.
MshType msh_type(const MshInput& in, int type);

/// Row of a node by its tag. Tags that lie close together are looked up in a table, others by
/// bisection: its size is bounded by the number of nodes, not by their tags.
class NodeIndex
{
 public:
  NodeIndex() = default;
  /// Failure (65) for tags that are not positive, or twice there.
  NodeIndex(const MshInput& in, const std::vector<std::int64_t>& tags);
  int row(std::int64_t tag) const;  ///< -1: there is none

 private:
  std::int64_t first_ = 0;
  std::vector<int> table_;
  std::vector<std::pair<std::int64_t, int>> sorted_;
};

/// A file half read.
struct MshReading
{
  MshFormat format;
  std::set<std::string> seen;                                 ///< sections
  std::map<std::pair<int, int>, std::vector<int>> groups_of;  ///< by dimension and entity
  std::map<std::pair<int, int>, std::string> names;           ///< by dimension and group
  NodeIndex index;
  MshFile mesh;
};

/// The dimension of an entity.
int dimension(MshInput& in);
void read_entities(MshInput& in, MshReading& reading);
void read_nodes_2(MshInput& in, MshReading& reading);
void read_nodes_4(MshInput& in, MshReading& reading);
void read_elements_2(MshInput& in, MshReading& reading);
void read_elements_4(MshInput& in, MshReading& reading);

}  // namespace trocar::io
