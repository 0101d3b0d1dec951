#include "mesh/topology.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "mesh/quadratic.hpp"

namespace trocar::mesh {
namespace {

// Corners of the faces of a positively oriented tet. Face k is opposite to corner k; normals point
// outward.
constexpr std::array<std::array<std::size_t, 3>, 4> tet_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Tets around each node, if tet t has the nodes `nodes_of_tet(t)`.
template <class NodesOfTet>
NodeToTets tets_around(const Mesh& mesh, const NodesOfTet& nodes_of_tet)
{
  NodeToTets map;
  map.start.assign(mesh.x.size() + 1, 0);
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : nodes_of_tet(t)) ++map.start[static_cast<std::size_t>(node) + 1];
  std::partial_sum(map.start.begin(), map.start.end(), map.start.begin());
  map.tet.resize(static_cast<std::size_t>(map.start.back()));
  std::vector<int> next(map.start.begin(), map.start.end() - 1);
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : nodes_of_tet(t))
      map.tet[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = t;
  return map;
}

/// Adds the faces of tet t that have `node` as their lowest-numbered node.
void add_faces_from(const Mesh& mesh, int t, int node, std::vector<TetFace>& faces)
{
  const Tet& tet = mesh.tets[static_cast<std::size_t>(t)];
  for (std::size_t opposite = 0; opposite < 4; ++opposite) {
    const auto& local = tet_faces[opposite];
    const Face face{tet[local[0]], tet[local[1]], tet[local[2]]};
    const std::size_t least = face[0] == node ? 0 : face[1] == node ? 1 : face[2] == node ? 2 : 3;
    if (least == 3) continue;
    const int second = face[(least + 1) % 3], third = face[(least + 2) % 3];
    if (second < node || third < node) continue;
    faces.push_back({{node, std::min(second, third), std::max(second, third)},
                     t,
                     static_cast<int>(opposite),
                     third < second});
  }
}

}  // namespace

Face sorted(Face face)
{
  std::sort(face.begin(), face.end());
  return face;
}

NodeToTets node_to_tets(const Mesh& mesh)
{
  return tets_around(mesh, [&](int t) { return nodes_of(mesh, t); });
}

void visit_faces(const Mesh& mesh, const std::function<void(std::span<const TetFace>)>& visit)
{
  const NodeToTets around = tets_around(
      mesh, [&](int t) -> const Tet& { return mesh.tets[static_cast<std::size_t>(t)]; });
  std::vector<TetFace> faces;
  for (int node = 0; node < mesh.node_count(); ++node) {
    faces.clear();
    const auto at = static_cast<std::size_t>(node);
    for (int i = around.start[at]; i < around.start[at + 1]; ++i)
      add_faces_from(mesh, around.tet[static_cast<std::size_t>(i)], node, faces);
    std::sort(faces.begin(), faces.end(), [](const TetFace& a, const TetFace& b) {
      return std::tie(a.nodes, a.tet) < std::tie(b.nodes, b.tet);
    });
    for (auto first = faces.begin(); first != faces.end();) {
      auto next = first;
      while (next != faces.end() && next->nodes == first->nodes) ++next;
      visit({first, next});
      first = next;
    }
  }
}

std::vector<BoundaryFace> boundary_faces(const Mesh& mesh)
{
  std::vector<TetFace> single;
  visit_faces(mesh, [&](std::span<const TetFace> same) {
    if (same.size() == 1) single.push_back(same.front());
  });
  std::sort(single.begin(), single.end(), [](const TetFace& a, const TetFace& b) {
    return std::tie(a.tet, a.local) < std::tie(b.tet, b.local);
  });
  std::vector<BoundaryFace> boundary;
  for (const TetFace& face : single) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(face.tet)];
    const auto& local = tet_faces[static_cast<std::size_t>(face.local)];
    boundary.push_back({{tet[local[0]], tet[local[1]], tet[local[2]]}, face.tet});
  }
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
