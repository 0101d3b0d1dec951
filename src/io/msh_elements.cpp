#include "io/msh_sections.hpp"

#include <algorithm>
#include <array>
#include <limits>

// Reads $Elements of a Gmsh file. In MSH 2.2 each element lists its physical group and its entity.
// In MSH 4.1 elements are listed by entity, and $Entities lists the groups of each entity.
namespace trocar::io {
namespace {

constexpr int tet_4 = 4, tet_10 = 11;

std::string number(std::int64_t value)
{
  return std::to_string(value);
}

void read_rows(MshInput& in, const MshReading& reading, int nodes, std::int64_t tag,
               std::vector<int>& rows)
{
  for (int a = 0; a < nodes; ++a) {
    const std::int64_t node =
        reading.format.binary && !reading.format.four ? in.integer() : in.size();
    const int row = reading.index.row(node);
    if (row < 0)
      throw in.failure("element " + number(tag) + " has node " + number(node) +
                       ", which the file has not");
    rows.push_back(row);
  }
}

void count_loose(int type, std::int64_t elements, MshReading& reading)
{
  if (type == tet_4 || type == tet_10) reading.mesh.loose_tets += elements;
}

/// Collects the elements of an MSH 2.2 file in blocks while they are read.
class Blocks
{
 public:
  explicit Blocks(MshFile& mesh) : mesh_(&mesh) {}

  /// The block for elements of this type, physical group and entity; made at its first use. An MSH
  /// 2.2 element is in one group at most.
  MshFile::Block& of(int type, int dim, int group, int entity)
  {
    const std::array<int, 3> key{type, group, entity};
    if (last_ && key == key_) return mesh_->blocks[*last_];
    const auto [place, fresh] = known_.emplace(key, mesh_->blocks.size());
    if (fresh) mesh_->blocks.push_back({type, dim, entity, {group}, {}, {}});
    key_ = key;
    last_ = &place->second;
    return mesh_->blocks[*last_];
  }

 private:
  MshFile* mesh_;
  std::map<std::array<int, 3>, std::size_t> known_;
  std::array<int, 3> key_{};
  const std::size_t* last_ = nullptr;
};

/// Data before the node list of an MSH 2.2 element.
struct Head
{
  int type, tags;
  std::int64_t element;
};

void read_element_2(MshInput& in, const Head& head, Blocks& blocks, MshReading& reading)
{
  constexpr int most_tags = 1000;
  const MshType of = msh_type(in, head.type);
  if (head.tags < 0 || head.tags > most_tags)
    throw in.failure("element " + number(head.element) + " has " + number(head.tags) + " tags");
  std::array<int, 3> tags{};  // physical group, entity, number of partitions
  for (int k = 0; k < head.tags; ++k) {
    const int tag = in.integer();
    if (k < 3) tags[static_cast<std::size_t>(k)] = tag;
  }
  if (tags[2] > 0) throw in.failure(partitioned);
  const int group = tags[0] < 0 && tags[0] > std::numeric_limits<int>::min() ? -tags[0] : tags[0];
  if (group == 0) {
    std::vector<int> unused;
    read_rows(in, reading, of.nodes, head.element, unused);
    count_loose(head.type, 1, reading);
    return;
  }
  MshFile::Block& block = blocks.of(head.type, of.dim, group, tags[1]);
  block.tags.push_back(head.element);
  read_rows(in, reading, of.nodes, head.element, block.nodes);
}

}  // namespace

void read_elements_2(MshInput& in, MshReading& reading)
{
  const bool binary = reading.format.binary;
  const std::int64_t elements = in.count(in.size(), binary ? 8 : 6);
  if (binary) in.begin_bytes();
  Blocks blocks(reading.mesh);
  Head head{};
  std::int64_t more = 0;  // elements left in a binary block; they share one head
  for (std::int64_t i = 0; i < elements; ++i) {
    if (binary && more == 0) {
      head.type = in.integer();
      more = in.count(in.integer(), 8);
      head.tags = in.integer();
      if (more < 1 || more > elements - i)
        throw in.failure("a block of " + number(more) + " elements where " + number(elements - i) +
                         " are due");
    }
    --more;
    head.element = binary ? in.integer() : in.size();
    if (!binary) {
      head.type = in.integer();
      head.tags = in.integer();
    }
    read_element_2(in, head, blocks, reading);
  }
}

void read_elements_4(MshInput& in, MshReading& reading)
{
  if (reading.format.binary) in.begin_bytes();
  const bool binary = reading.format.binary;
  const std::int64_t blocks = in.count(in.size(), 8);
  const std::int64_t elements = in.count(in.size(), binary ? 16 : 4);
  in.size(), in.size();  // smallest and largest tag, not used
  std::int64_t read = 0;
  for (std::int64_t block = 0; block < blocks; ++block) {
    const int dim = dimension(in), entity = in.integer(), type = in.integer();
    const MshType of = msh_type(in, type);
    if (of.dim != dim)
      throw in.failure("elements of type " + number(type) + " on an entity of dimension " +
                       number(dim));
    const auto values = static_cast<std::size_t>(of.nodes) + 1;
    const std::int64_t here = in.count(in.size(), (binary ? 8 : 2) * values);
    read += here;
    const auto known = reading.groups_of.find(std::pair(dim, entity));
    if (known == reading.groups_of.end() && reading.seen.count("Entities"))
      throw in.failure("entity " + number(entity) + " of dimension " + number(dim) +
                       " is not among $Entities");
    MshFile::Block all{type, dim, entity, {}, {}, {}};
    if (known != reading.groups_of.end()) all.groups = known->second;
    all.tags.reserve(static_cast<std::size_t>(here));
    all.nodes.reserve(static_cast<std::size_t>(here) * (values - 1));
    for (std::int64_t i = 0; i < here; ++i) {
      all.tags.push_back(in.size());
      read_rows(in, reading, of.nodes, all.tags.back(), all.nodes);
    }
    if (all.groups.empty())
      count_loose(type, here, reading);
    else
      reading.mesh.blocks.push_back(std::move(all));
  }
  if (read != elements)
    throw in.failure(number(elements) + " elements are announced, and its blocks have " +
                     number(read));
}

}  // namespace trocar::io
