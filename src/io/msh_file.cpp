#include "io/msh_file.hpp"

#include <array>
#include <map>

#include "core/words.hpp"
#include "io/msh_sections.hpp"

namespace trocar::io {
namespace {

// Dimension and number of nodes of Gmsh's element types 1, 2, ... (Gmsh manual, "MSH file format").
constexpr std::array<MshType, 31> types{
    {{1, 2},  {2, 3},  {2, 4},  {3, 4}, {3, 8}, {3, 6},  {3, 5},  {1, 3},  {2, 6}, {2, 9},  {3, 10},
     {3, 27}, {3, 18}, {3, 14}, {0, 1}, {2, 8}, {3, 20}, {3, 15}, {3, 13}, {2, 9}, {2, 10}, {2, 12},
     {2, 15}, {2, 15}, {2, 21}, {1, 4}, {1, 5}, {1, 6},  {3, 20}, {3, 35}, {3, 56}}};

void read_format(MshInput& in, MshFormat& format)
{
  const std::string version = in.word();
  if (version == "4.1")
    format.four = true;
  else if (version != "2.2")
    throw in.failure("MSH version '" + core::printable(version, 20) +
                     "': 2.2 and 4.1 are read (gmsh -save -format msh41 converts)");
  const std::int32_t type = in.integer(), bytes = in.integer();
  if (type != 0 && type != 1)
    throw in.failure("file type " + std::to_string(type) + ": 0, ascii, or 1, binary, is due");
  if (bytes != 8)
    throw in.failure("numbers of " + std::to_string(bytes) + " bytes: those of 8 are read");
  format.binary = type == 1;
  if (format.binary) {
    in.begin_bytes();
    if (in.integer() != 1) throw in.failure("the bytes are in the order of another machine");
  }
}

/// Reads $PhysicalNames: dimension, tag and name of each group. They are text even in binary files.
void read_names(MshInput& in, std::map<std::pair<int, int>, std::string>& names)
{
  const std::int64_t groups = in.count(in.size(), 6);
  for (std::int64_t i = 0; i < groups; ++i) {
    const int dim = in.integer(), tag = in.integer();
    const std::string rest = in.line();
    const std::size_t open = rest.find('"'), close = rest.rfind('"');
    if (open == std::string::npos || open == close)
      throw in.failure("the name of a physical group is not in quotes");
    if (dim < 0 || dim > 3)
      throw in.failure("a physical group of dimension " + std::to_string(dim));
    const std::string name = rest.substr(open + 1, close - open - 1);
    const auto [known, fresh] = names.emplace(std::pair(dim, tag), name);
    if (!fresh && known->second != name)
      throw in.failure("physical group " + std::to_string(tag) + " of dimension " +
                       std::to_string(dim) + " has two names, '" + core::printable(known->second) +
                       "' and '" + core::printable(name) + "'");
  }
}

void refuse_section(const MshInput& in, const std::string& name)
{
  if (name == "PartitionedEntities" || name == "GhostElements" || name == "PartitionedNodes")
    throw in.failure(partitioned);
  if (name == "ParametricNodes") throw in.failure("save the mesh with Mesh.SaveParametric = 0");
  if (name == "NOD" || name == "ELM" || name == "NOE")
    throw in.failure("MSH version 1: 2.2 and 4.1 are read (gmsh -save -format msh41 converts)");
}

/// Lists the groups that have a name or contain elements.
void list_groups(MshReading& reading)
{
  for (const MshFile::Block& block : reading.mesh.blocks)
    for (int tag : block.groups) reading.names.emplace(std::pair(block.dim, tag), "");
  for (auto& [group, name] : reading.names)
    reading.mesh.groups.push_back({group.first, group.second, std::move(name)});
}

/// Reads a section, or skips one that does not describe the mesh. Only a skipped section may occur
/// twice.
void read_section(MshInput& in, const std::string& name, MshReading& reading)
{
  MshFile& mesh = reading.mesh;
  const bool four = reading.format.four;
  if (name == "PhysicalNames") {
    read_names(in, reading.names);
  } else if (name == "Entities" && four) {
    read_entities(in, reading);
  } else if (name == "Nodes") {
    four ? read_nodes_4(in, reading) : read_nodes_2(in, reading);
    reading.index = NodeIndex(in, mesh.node_tag);
  } else if (name == "Elements") {
    if (!reading.seen.count("Nodes")) throw in.failure("$Nodes must come before");
    four ? read_elements_4(in, reading) : read_elements_2(in, reading);
  } else {
    refuse_section(in, name);
    in.skip_section();
    return;
  }
  in.end_section();
  if (!reading.seen.insert(name).second) throw in.failure("the file has this section twice");
}

}  // namespace

MshType msh_type(const MshInput& in, int type)
{
  if (type == 92) return {3, 64};  // 92 and 93: hexahedra of third and fourth order
  if (type == 93) return {3, 125};
  if (type < 1 || type > static_cast<int>(types.size()))
    throw in.failure("Gmsh has no element type " + std::to_string(type));
  return types[static_cast<std::size_t>(type) - 1];
}

MshFile read_msh(const std::string& file)
{
  MshInput in(file);
  MshReading reading;
  reading.mesh.file = file;
  if (in.begin_section() != "MeshFormat")
    throw in.failure("no Gmsh mesh: it does not begin with $MeshFormat");
  read_format(in, reading.format);
  in.end_section();
  for (std::string name = in.begin_section(); !name.empty(); name = in.begin_section())
    read_section(in, name, reading);
  for (const char* needed : {"Nodes", "Elements"})
    if (!reading.seen.count(needed)) throw in.failure(std::string("the file has no $") + needed);
  list_groups(reading);
  reading.mesh.hash = in.hash();
  return std::move(reading.mesh);
}

}  // namespace trocar::io
