#include "mesh/topology.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "mesh/quadratic.hpp"

namespace trocar::mesh {
namespace {

// Local faces of a positively oriented tet, normals outward.
constexpr std::array<std::array<std::size_t, 3>, 4> tet_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace

Face sorted(Face face)
{
  std::sort(face.begin(), face.end());
  return face;
}

NodeToTets node_to_tets(const Mesh& mesh)
{
  NodeToTets map;
  map.start.assign(mesh.x.size() + 1, 0);
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : nodes_of(mesh, t)) ++map.start[static_cast<std::size_t>(node) + 1];
  std::partial_sum(map.start.begin(), map.start.end(), map.start.begin());
  map.tet.resize(static_cast<std::size_t>(map.start.back()));
  std::vector<int> next(map.start.begin(), map.start.end() - 1);
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : nodes_of(mesh, t))
      map.tet[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = t;
  return map;
}

std::vector<BoundaryFace> boundary_faces(const Mesh& mesh)
{
  struct Seen
  {
    int count = 0;
    std::size_t first = 0;
  };
  std::vector<BoundaryFace> all;
  std::map<Face, Seen> seen;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(t)];
    for (const auto& local : tet_faces) {
      const Face face{tet[local[0]], tet[local[1]], tet[local[2]]};
      Seen& entry = seen[sorted(face)];
      if (entry.count == 0) entry.first = all.size();
      if (++entry.count > 2)
        throw core::data_error(mesh.file + ": tetrahedron " +
                               std::to_string(mesh.elem_tag[static_cast<std::size_t>(t)]) +
                               " shares a face with two others");
      all.push_back({face, t});
    }
  }
  std::vector<std::size_t> single;
  for (const auto& [face, entry] : seen)
    if (entry.count == 1) single.push_back(entry.first);
  std::sort(single.begin(), single.end());
  std::vector<BoundaryFace> boundary;
  for (std::size_t i : single) boundary.push_back(all[i]);
  return boundary;
}

std::vector<int> connected_components(const Mesh& mesh, int& count)
{
  std::vector<int> parent(mesh.x.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int node) {
    while (parent[static_cast<std::size_t>(node)] != node) {
      int& up = parent[static_cast<std::size_t>(node)];
      up = parent[static_cast<std::size_t>(up)];
      node = up;
    }
    return node;
  };
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    for (int node : nodes) parent[static_cast<std::size_t>(root_of(node))] = root_of(nodes.node[0]);
  }
  std::vector<int> component(mesh.x.size());
  std::map<int, int> number;
  for (int i = 0; i < mesh.node_count(); ++i)
    component[static_cast<std::size_t>(i)] =
        number.emplace(root_of(i), static_cast<int>(number.size())).first->second;
  count = static_cast<int>(number.size());
  return component;
}

}  // namespace trocar::mesh
