#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/msh_file.hpp"
#include "io/msh_input.hpp"

// Readers of the sections of a Gmsh file. Only read_msh uses them.
namespace trocar::io {

inline constexpr const char* partitioned =
    "the mesh is partitioned: save it whole (the program divides it itself)";

struct MshFormat
{
  bool four = false;  ///< MSH 4.1; false: MSH 2.2
  bool binary = false;
};

/// Dimension and number of nodes of an element type.
struct MshType
{
  int dim, nodes;
};
/// Dimension and nodes of Gmsh's type number `type`. Failure (65) when Gmsh has no such type.
MshType msh_type(const MshInput& in, int type);

/// Finds the index of a node by its tag. Dense tags are looked up in a table, others by bisection
/// in a sorted list. So the memory is bounded by the number of nodes, whatever the tags are.
class NodeIndex
{
 public:
  NodeIndex() = default;
  /// Throws Failure (65) when a tag is not positive or occurs twice.
  NodeIndex(const MshInput& in, const std::vector<std::int64_t>& tags);
  int row(std::int64_t tag) const;  ///< index in the list of tags; -1: no such node

 private:
  std::int64_t first_ = 0;
  std::vector<int> table_;
  std::vector<std::pair<std::int64_t, int>> sorted_;
};

/// Data collected while a file is being read.
struct MshReading
{
  MshFormat format;
  std::set<std::string> seen;  ///< sections read so far
  /// Physical groups; key: dimension, entity.
  std::map<std::pair<int, int>, std::vector<int>> groups_of;
  std::map<std::pair<int, int>, std::string> names;  ///< names of groups; key: dimension, tag
  NodeIndex index;
  MshFile mesh;
};

/// Reads the dimension of an entity. Failure (65) unless it is 0 to 3.
int dimension(MshInput& in);
void read_entities(MshInput& in, MshReading& reading);
void read_nodes_2(MshInput& in, MshReading& reading);
void read_nodes_4(MshInput& in, MshReading& reading);
void read_elements_2(MshInput& in, MshReading& reading);
void read_elements_4(MshInput& in, MshReading& reading);

}  // namespace trocar::io
