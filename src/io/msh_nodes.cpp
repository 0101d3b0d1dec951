#include "io/msh_sections.hpp"

#include <algorithm>
#include <array>
#include <limits>

// Reads $Entities and $Nodes of a Gmsh file. In MSH 4.1 both have the same fields in ascii and
// binary (Gmsh manual, "MSH file format").
namespace trocar::io {
namespace {

std::string number(std::int64_t value)
{
  return std::to_string(value);
}

/// Smallest size of a node: its tag and three coordinates [B].
std::size_t least_of_node(const MshFormat& format)
{
  if (!format.binary) return 8;
  return format.four ? 32 : 28;
}

void reserve_nodes(MshInput& in, std::int64_t nodes, MshReading& reading)
{
  if (nodes > std::numeric_limits<int>::max() / 4)
    throw in.failure(number(nodes) + " nodes are more than the program can number");
  reading.mesh.node_tag.reserve(static_cast<std::size_t>(nodes));
  reading.mesh.x.reserve(3 * static_cast<std::size_t>(nodes));
}

/// Reads a list of tags: their number, then the tags.
std::vector<int> tags_of(MshInput& in)
{
  const std::int64_t tags = in.count(in.size(), 2);
  std::vector<int> all;
  for (std::int64_t i = 0; i < tags; ++i) all.push_back(in.integer());
  return all;
}

/// The physical groups of an entity, sorted and without signs. A negative tag means reversed
/// orientation, which is ignored here.
std::vector<int> groups_in(std::vector<int> tags)
{
  for (int& tag : tags)
    if (tag < 0 && tag != std::numeric_limits<int>::min()) tag = -tag;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

}  // namespace

int dimension(MshInput& in)
{
  const int dim = in.integer();
  if (dim < 0 || dim > 3) throw in.failure("an entity of dimension " + number(dim));
  return dim;
}

NodeIndex::NodeIndex(const MshInput& in, const std::vector<std::int64_t>& tags)
{
  if (tags.empty()) return;
  const auto twice = [&](std::int64_t tag) {
    return in.failure("node " + number(tag) + " is there twice");
  };
  const auto [low, high] = std::minmax_element(tags.begin(), tags.end());
  first_ = *low;
  if (first_ < 1) throw in.failure("node " + number(first_) + ": tags are positive");
  const auto count = static_cast<std::int64_t>(tags.size());
  if (*high - first_ < 4 * count + 1000) {
    table_.assign(static_cast<std::size_t>(*high - first_ + 1), -1);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      int& row = table_[static_cast<std::size_t>(tags[i] - first_)];
      if (row >= 0) throw twice(tags[i]);
      row = static_cast<int>(i);
    }
    return;
  }
  for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<int>(i));
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i].first == sorted_[i - 1].first) throw twice(sorted_[i].first);
}

int NodeIndex::row(std::int64_t tag) const
{
  if (!sorted_.empty()) {
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, 0));
    return found != sorted_.end() && found->first == tag ? found->second : -1;
  }
  if (tag < first_ || tag - first_ >= static_cast<std::int64_t>(table_.size())) return -1;
  return table_[static_cast<std::size_t>(tag - first_)];
}

void read_entities(MshInput& in, MshReading& reading)
{
  if (reading.format.binary) in.begin_bytes();
  std::array<std::int64_t, 4> counts{};
  for (std::int64_t& count : counts) count = in.count(in.size(), 8);
  for (int dim = 0; dim < 4; ++dim)
    for (std::int64_t i = 0; i < counts[static_cast<std::size_t>(dim)]; ++i) {
      const int tag = in.integer();
      // Position of a point, else a bounding box; not used.
      for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) in.real();
      std::vector<int> groups = groups_in(tags_of(in));
      if (dim > 0) tags_of(in);  // entities on its boundary, not used
      if (!reading.groups_of.emplace(std::pair(dim, tag), std::move(groups)).second)
        throw in.failure("entity " + number(tag) + " of dimension " + number(dim) +
                         " is there twice");
    }
}

void read_nodes_2(MshInput& in, MshReading& reading)
{
  const std::int64_t nodes = in.count(in.size(), least_of_node(reading.format));
  if (reading.format.binary) in.begin_bytes();
  reserve_nodes(in, nodes, reading);
  for (std::int64_t i = 0; i < nodes; ++i) {
    reading.mesh.node_tag.push_back(reading.format.binary ? in.integer() : in.size());
    for (int k = 0; k < 3; ++k) reading.mesh.x.push_back(in.real());
  }
}

void read_nodes_4(MshInput& in, MshReading& reading)
{
  if (reading.format.binary) in.begin_bytes();
  const std::int64_t blocks = in.count(in.size(), 8);
  const std::int64_t nodes = in.count(in.size(), least_of_node(reading.format));
  in.size(), in.size();  // smallest and largest tag, not used
  reserve_nodes(in, nodes, reading);
  std::int64_t read = 0;
  for (std::int64_t block = 0; block < blocks; ++block) {
    const int dim = dimension(in);
    in.integer();  // tag of the entity, not used
    const int parametric = in.integer();
    if (parametric != 0 && parametric != 1)
      throw in.failure("a block of nodes is parametric " + number(parametric) + ": 0 or 1 is due");
    const std::int64_t here = in.count(in.size(), least_of_node(reading.format));
    read += here;
    if (read > nodes) break;
    for (std::int64_t i = 0; i < here; ++i) reading.mesh.node_tag.push_back(in.size());
    for (std::int64_t i = 0; i < here; ++i) {
      for (int k = 0; k < 3; ++k) reading.mesh.x.push_back(in.real());
      for (int k = 0; k < parametric * dim; ++k) in.real();
    }
  }
  if (read != nodes)
    throw in.failure(number(nodes) + " nodes are announced, and its blocks have " +
                     (read > nodes ? "more" : number(read)));
}

}  // namespace trocar::io
