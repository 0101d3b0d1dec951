#include "io/msh_groups.hpp"

#include <algorithm>
#include <map>

#include "core/failure.hpp"

namespace trocar::io {

std::vector<MshGroup> msh_groups(const MshFile& file, int dim, std::vector<std::string>& remarks)
{
  const std::string kind = msh_kinds[dim];
  std::vector<MshGroup> all;
  std::map<std::string, std::size_t> of_name;
  std::map<int, std::size_t> of_tag;
  for (const MshFile::Group& one : file.groups) {
    if (one.dim != dim) continue;
    const std::string name = one.name.empty() ? kind + "_" + std::to_string(one.tag) : one.name;
    const auto [known, fresh] = of_name.emplace(name, all.size());
    of_tag.emplace(one.tag, known->second);
    if (fresh)
      all.push_back({name, one.tag, {}});
    else
      remarks.push_back("physical " + kind + "s " + std::to_string(all[known->second].tag) +
                        " and " + std::to_string(one.tag) + " are both named '" + name +
                        "': they are one group");
  }
  for (const MshFile::Block& block : file.blocks)
    for (int tag : block.dim == dim ? block.groups : std::vector<int>()) {
      std::vector<const MshFile::Block*>& blocks = all[of_tag.at(tag)].blocks;
      if (blocks.empty() || blocks.back() != &block) blocks.push_back(&block);
    }
  for (MshGroup& group : all)
    std::stable_sort(group.blocks.begin(), group.blocks.end(),
                     [](const auto* a, const auto* b) { return a->entity < b->entity; });
  return all;
}

MshTets msh_tets(const MshFile& file, const std::vector<MshGroup>& volumes, std::size_t nodes_each)
{
  MshTets raw{{}, {}, {}, nodes_each};
  std::size_t count = 0;
  for (const MshGroup& volume : volumes)
    for (const MshFile::Block* block : volume.blocks) count += block->tags.size();
  raw.tets.reserve(count);
  for (std::size_t region = 0; region < volumes.size(); ++region)
    for (const MshFile::Block* block : volumes[region].blocks) {
      const int number = static_cast<int>(raw.blocks.size());
      for (std::size_t i = 0; i < block->tags.size(); ++i)
        raw.tets.push_back({number, static_cast<int>(i)});
      raw.blocks.push_back(block);
      raw.region.push_back(static_cast<int>(region));
    }
  const auto before = [&](const MshTets::Place& a, const MshTets::Place& b) {
    return raw.tag(a) < raw.tag(b);
  };
  if (!std::is_sorted(raw.tets.begin(), raw.tets.end(), before))
    std::stable_sort(raw.tets.begin(), raw.tets.end(), before);
  for (std::size_t i = 1; i < raw.tets.size(); ++i) {
    const MshTets::Place &a = raw.tets[i - 1], &b = raw.tets[i];
    if (raw.tag(a) != raw.tag(b)) continue;
    const auto name = [&](const MshTets::Place& at) {
      return "'" + volumes[static_cast<std::size_t>(raw.region_of(at))].name + "'";
    };
    if (raw.region_of(a) != raw.region_of(b))
      throw core::data_error(file.file + ": tetrahedron " + std::to_string(raw.tag(a)) +
                             " is in two physical volumes, " + name(a) + " and " + name(b));
    if (!std::equal(raw.nodes(a), raw.nodes(a) + raw.nodes_each, raw.nodes(b)))
      throw core::data_error(file.file + ": two tetrahedra have the tag " +
                             std::to_string(raw.tag(a)));
  }
  return raw;
}

}  // namespace trocar::io
