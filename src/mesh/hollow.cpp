#include "mesh/hollow.hpp"

#include <algorithm>
#include <set>

#include "core/words.hpp"
#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::mesh {
namespace {

/// Index of the volume to be removed; Failure (65) where it cannot be.
int volume_index(const Mesh& mesh, const std::string& volume)
{
  const auto at = std::find(mesh.volumes.begin(), mesh.volumes.end(), volume);
  if (at == mesh.volumes.end())
    throw core::data_error(mesh.file + ": no physical volume '" + volume + "'" +
                           core::did_you_mean(volume, mesh.volumes));
  if (mesh.volumes.size() == 1)
    throw core::data_error(mesh.file + ": without volume '" + volume + "' no tissue is left");
  for (const SurfaceGroup& surface : mesh.surfaces)
    if (surface.name == volume)
      throw core::data_error(mesh.file + ": volume '" + volume +
                             "' cannot be hollowed: a physical surface has its name");
  return static_cast<int>(at - mesh.volumes.begin());
}

/// The tets outside the volume and their nodes, without physical groups. `number` gets the new
/// number of every old node, -1 for a dropped node.
Mesh without(const Mesh& mesh, int volume, std::vector<int>& number)
{
  Mesh rest;
  rest.file = mesh.file;
  rest.hash = mesh.hash;
  rest.unit = mesh.unit;
  rest.remarks = mesh.remarks;
  rest.volumes = mesh.volumes;
  rest.volumes.erase(rest.volumes.begin() + volume);
  rest.file_of = mesh.file_of;
  if (!rest.file_of.empty()) rest.file_of.erase(rest.file_of.begin() + volume);
  number.assign(mesh.x.size(), -1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.region[t] != volume)
      for (int node : nodes_of(mesh, static_cast<int>(t)))
        number[static_cast<std::size_t>(node)] = 0;
  for (std::size_t i = 0; i < mesh.x.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = rest.node_count();
    rest.x.push_back(mesh.x[i]);
    rest.node_tag.push_back(mesh.node_tag[i]);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region[t] == volume) continue;
    Tet tet = mesh.tets[t];
    for (int& node : tet) node = number[static_cast<std::size_t>(node)];
    rest.tets.push_back(tet);
    if (mesh.quadratic()) {
      Middles middles = mesh.middles[t];
      for (int& node : middles) node = number[static_cast<std::size_t>(node)];
      rest.middles.push_back(middles);
    }
    rest.region.push_back(mesh.region[t] - (mesh.region[t] > volume ? 1 : 0));
    rest.elem_tag.push_back(mesh.elem_tag[t]);
  }
  rest.index_middles();
  return rest;
}

/// The group in the new numbering, without dropped nodes and their edges.
PointGroup renumbered_group(const PointGroup& group, const std::vector<int>& number)
{
  PointGroup kept{group.name, {}, {}};
  const auto now = [&](int node) { return number[static_cast<std::size_t>(node)]; };
  for (int node : group.nodes)
    if (now(node) >= 0) kept.nodes.push_back(now(node));
  for (const auto& [a, b] : group.edges)
    if (now(a) >= 0 && now(b) >= 0) kept.edges.push_back({now(a), now(b)});
  return kept;
}

}  // namespace

Mesh hollow(const Mesh& mesh, const std::string& volume)
{
  const int index = volume_index(mesh, volume);
  std::vector<int> number;
  Mesh rest = without(mesh, index, number);
  std::set<Face> of_tets;
  for (const Tet& tet : rest.tets)
    for (std::size_t k = 0; k < 4; ++k)
      of_tets.insert(sorted({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]}));
  const auto renumbered = [&](Face face) {
    for (int& node : face) node = number[static_cast<std::size_t>(node)];
    return face;
  };
  for (const SurfaceGroup& surface : mesh.surfaces) {
    SurfaceGroup kept{surface.name, {}};
    for (const Face& face : surface.faces)
      if (of_tets.count(sorted(renumbered(face)))) kept.faces.push_back(renumbered(face));
    if (!kept.faces.empty()) rest.surfaces.push_back(std::move(kept));
  }
  for (const PointGroup& point : mesh.points) {
    PointGroup kept = renumbered_group(point, number);
    if (!kept.nodes.empty()) rest.points.push_back(std::move(kept));
  }
  std::set<Face> removed;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region[t] != index) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const Tet& tet = mesh.tets[t];
      removed.insert(sorted(renumbered({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]})));
    }
  }
  SurfaceGroup wall{volume, {}};
  for (const Face& face : removed)
    if (of_tets.count(face)) wall.faces.push_back(face);
  rest.surfaces.push_back(std::move(wall));
  return rest;
}

}  // namespace trocar::mesh
