#include "tissue/patches.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace trocar::tissue {

Patches corner_patches(const fem::Space& space, const std::vector<int>& region)
{
  std::vector<char> whole(static_cast<std::size_t>(space.local()), 0);
  for (std::size_t e = 0; e < space.tets(); ++e) {
    const auto nodes = space.nodes(e);
    if (std::any_of(nodes.begin(), nodes.end(), [&](int n) { return n < space.owned(); }))
      for (std::size_t a = 0; a < 4; ++a) whole[static_cast<std::size_t>(nodes[a])] = 1;
  }
  Patches patches;
  std::map<std::pair<int, int>, int> number;  // of the patch, by node and volume
  std::vector<std::vector<Patches::Member>> members;
  for (std::size_t e = 0; e < space.tets(); ++e) {
    std::array<int, 4>& mine = patches.of_tet.emplace_back();
    for (std::size_t a = 0; a < 4; ++a) {
      const int node = space.nodes(e)[a];
      mine[a] = -1;
      if (!whole[static_cast<std::size_t>(node)]) continue;
      const auto next = static_cast<int>(number.size());
      const auto [at, fresh] = number.try_emplace({node, region[e]}, next);
      if (fresh) {
        patches.region.push_back(region[e]);
        members.emplace_back();
      }
      mine[a] = at->second;
      members[static_cast<std::size_t>(mine[a])].push_back({e, static_cast<int>(a)});
    }
  }
  patches.measure.assign(members.size(), 0.0);
  patches.start.push_back(0);
  for (const auto& of_patch : members) {
    patches.member.insert(patches.member.end(), of_patch.begin(), of_patch.end());
    patches.start.push_back(patches.member.size());
  }
  return patches;
}

fem::Cliques patch_nodes(const Patches& patches, const fem::Space& space)
{
  fem::Cliques cliques;
  for (std::size_t v = 0; v < patches.size(); ++v) {
    std::vector<int> nodes;
    for (std::size_t k = patches.start[v]; k < patches.start[v + 1]; ++k) {
      const auto of_tet = space.nodes(patches.member[k].tet);
      nodes.insert(nodes.end(), of_tet.begin(), of_tet.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    cliques.node.insert(cliques.node.end(), nodes.begin(), nodes.end());
    cliques.start.push_back(cliques.node.size());
  }
  return cliques;
}

}  // namespace trocar::tissue
