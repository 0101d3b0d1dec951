#include "mesh/soundness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "core/words.hpp"
#include "mesh/locator.hpp"
#include "mesh/topology.hpp"

namespace trocar::mesh {
namespace {

std::string tag_of(const Mesh& mesh, int tet)
{
  return std::to_string(mesh.elem_tag[static_cast<std::size_t>(tet)]);
}

std::string node_tag_of(const Mesh& mesh, int node)
{
  return std::to_string(mesh.node_tag[static_cast<std::size_t>(node)]);
}

std::string counted(long long number, const std::string& one, const std::string& more)
{
  return std::to_string(number) + " " + (number == 1 ? one : more);
}

/// Triangle number `place` of surface number `surface`, with its nodes ascending.
struct Triangle
{
  Face nodes;
  std::size_t surface, place;
};

std::vector<Triangle> triangles_of(const Mesh& mesh)
{
  std::vector<Triangle> all;
  for (std::size_t s = 0; s < mesh.surfaces.size(); ++s)
    for (std::size_t i = 0; i < mesh.surfaces[s].faces.size(); ++i)
      all.push_back({sorted(mesh.surfaces[s].faces[i]), s, i});
  std::sort(all.begin(), all.end(), [](const Triangle& a, const Triangle& b) {
    return std::tie(a.nodes, a.surface, a.place) < std::tie(b.nodes, b.surface, b.place);
  });
  return all;
}

/// Failure (65) for a face of more than two tets, or of two tets on the same side of the face.
void refuse_face(const Mesh& mesh, std::span<const TetFace> same)
{
  const bool one_side = same.size() == 2 && same[0].turned == same[1].turned;
  if (same.size() <= 2 && !one_side) return;
  const Face& at = same.front().nodes;
  const std::string nodes = "(nodes " + node_tag_of(mesh, at[0]) + ", " + node_tag_of(mesh, at[1]) +
                            ", " + node_tag_of(mesh, at[2]) + ")";
  std::vector<long long> tags;
  for (const TetFace& face : same)
    tags.push_back(mesh.elem_tag[static_cast<std::size_t>(face.tet)]);
  const std::string which = mesh.file + ": tetrahedra " + core::listed(tags);
  throw core::data_error(
      which +
      (one_side ? " are on the same side of the face they share " : " have one face in common ") +
      nodes);
}

/// Keeps every triangle that is a face of a tet once. Other triangles become strays.
void sort_out(Mesh& mesh, const std::vector<Triangle>& triangles, const std::vector<bool>& is_face)
{
  std::vector<std::vector<bool>> keep;
  for (const SurfaceGroup& surface : mesh.surfaces) keep.emplace_back(surface.faces.size(), true);
  std::vector<long long> twice(mesh.surfaces.size(), 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& one = triangles[i];
    SurfaceGroup& surface = mesh.surfaces[one.surface];
    const bool again =
        i > 0 && triangles[i - 1].surface == one.surface && triangles[i - 1].nodes == one.nodes;
    if (again) ++twice[one.surface];
    if (!again && !is_face[i]) surface.strays.push_back(surface.tags[one.place]);
    if (again || !is_face[i]) keep[one.surface][one.place] = false;
  }
  for (std::size_t s = 0; s < mesh.surfaces.size(); ++s) {
    SurfaceGroup& surface = mesh.surfaces[s];
    std::vector<Face> faces;
    for (std::size_t i = 0; i < surface.faces.size(); ++i)
      if (keep[s][i]) faces.push_back(surface.faces[i]);
    surface.faces = std::move(faces);
    surface.tags = {};
    std::sort(surface.strays.begin(), surface.strays.end());
    const std::string name = "surface '" + surface.name + "': ";
    if (twice[s] > 0)
      mesh.remarks.push_back(name + counted(twice[s], "triangle is", "triangles are") +
                             " listed again: each counts once");
    if (!surface.strays.empty())
      mesh.remarks.push_back(
          name +
          counted(static_cast<long long>(surface.strays.size()), "triangle is", "triangles are") +
          " no face of a tetrahedron (" + core::listed(surface.strays) + "): it cannot be used");
  }
}

/// Adds a remark about edges with more than two boundary faces: there the boundary touches itself.
void tell_of_edges(Mesh& mesh, const std::vector<TetFace>& boundary)
{
  std::vector<std::array<int, 2>> edges;
  for (const TetFace& face : boundary) {
    edges.push_back({face.nodes[0], face.nodes[1]});
    edges.push_back({face.nodes[0], face.nodes[2]});
    edges.push_back({face.nodes[1], face.nodes[2]});
  }
  std::sort(edges.begin(), edges.end());
  long long count = 0;
  std::array<int, 2> first{};
  for (std::size_t i = 0; i + 2 < edges.size(); ++i) {
    if (edges[i] != edges[i + 2] || (i > 0 && edges[i] == edges[i - 1])) continue;
    if (count++ == 0) first = edges[i];
  }
  if (count > 0)
    mesh.remarks.push_back("the boundary meets itself along " + counted(count, "edge", "edges") +
                           " (the first: nodes " + node_tag_of(mesh, first[0]) + ", " +
                           node_tag_of(mesh, first[1]) + "): tetrahedra hang together there alone");
}

/// Adds a remark about boundary nodes with the same position, to 1e-9 of the mesh's extent.
void tell_of_coincident(Mesh& mesh, const std::vector<TetFace>& boundary)
{
  std::vector<int> nodes;
  for (const TetFace& face : boundary)
    nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  Vec3 low = mesh.x.front(), high = low;
  for (const Vec3& x : mesh.x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double cell = 1e-9 * (high - low).norm();
  const auto key = [&](int node) -> std::array<long long, 3> {
    const Vec3 at = (mesh.x[static_cast<std::size_t>(node)] - low) / cell;
    return {std::llround(at.x()), std::llround(at.y()), std::llround(at.z())};
  };
  std::vector<std::pair<std::array<long long, 3>, int>> places;
  for (int node : nodes) places.emplace_back(key(node), node);
  std::sort(places.begin(), places.end());
  long long count = 0;
  std::array<int, 2> first{};
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i].first == places[i - 1].first && count++ == 0)
      first = {places[i - 1].second, places[i].second};
  if (count > 0)
    mesh.remarks.push_back(counted(count, "node lies", "nodes lie") +
                           " where another one does (the first: " + node_tag_of(mesh, first[0]) +
                           " and " + node_tag_of(mesh, first[1]) +
                           "): the tissue is not glued together there");
}

/// Bounding box of a connected part [m], and its first node.
struct Part
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 high = -low;
  int node = -1;

  bool within(const Part& other) const
  {
    return (low.array() >= other.low.array()).all() && (high.array() <= other.high.array()).all();
  }
};

std::vector<Part> parts_of(const Mesh& mesh, const std::vector<int>& part, int count)
{
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < mesh.x.size(); ++i) {
    Part& one = parts[static_cast<std::size_t>(part[i])];
    one.low = one.low.cwiseMin(mesh.x[i]);
    one.high = one.high.cwiseMax(mesh.x[i]);
    if (one.node < 0) one.node = static_cast<int>(i);
  }
  return parts;
}

/// Number of parts whose first node lies inside a tet of another part. So a part that lies wholly
/// inside another one is found, although the tets at their boundaries do not overlap.
long long parts_inside_others(const Mesh& mesh, const std::vector<int>& part, int count)
{
  const std::vector<Part> parts = parts_of(mesh, part, count);
  std::optional<Locator> locator;  // made when the first box within another is found
  long long inside = 0;
  for (const Part& one : parts) {
    const auto holds = [&](const Part& other) { return &other != &one && one.within(other); };
    if (std::none_of(parts.begin(), parts.end(), holds)) continue;
    if (!locator) locator.emplace(mesh);
    const Vec3& at = mesh.x[static_cast<std::size_t>(one.node)];
    for (int tet : locator->in_box(at, at)) {
      const int corner = mesh.tets[static_cast<std::size_t>(tet)][0];
      const bool other =
          part[static_cast<std::size_t>(corner)] != part[static_cast<std::size_t>(one.node)];
      if (!other || barycentric(corners(mesh, tet), at).minCoeff() <= 1e-9) continue;
      ++inside;
      break;
    }
  }
  return inside;
}

void judge_overlap(Mesh& mesh, const std::vector<TetFace>& boundary)
{
  std::vector<int> tets;
  for (const TetFace& face : boundary) tets.push_back(face.tet);
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  int parts = 0;
  const std::vector<int> part = connected_components(mesh, parts);
  if (parts > 1)
    mesh.remarks.push_back("the mesh has " + std::to_string(parts) + " separate parts");
  const Overlap overlap = find_overlap(mesh, tets, part);
  if (overlap.tets[0] >= 0)
    throw core::data_error(mesh.file + ": tetrahedra " + tag_of(mesh, overlap.tets[0]) + " and " +
                           tag_of(mesh, overlap.tets[1]) + " of one connected part overlap");
  if (!overlap.whole)
    mesh.remarks.push_back(
        "so many tetrahedra share one place that not all pairs were looked at for overlap");
  if (overlap.between_parts > 0)
    mesh.remarks.push_back(
        "separate parts overlap: " + counted(overlap.between_parts, "pair", "pairs") +
        " of tetrahedra at their boundaries, by " + core::shown(overlap.depth) + " m at most");
  const long long inside = parts > 1 ? parts_inside_others(mesh, part, parts) : 0;
  if (inside > 0)
    mesh.remarks.push_back(counted(inside, "separate part begins", "separate parts begin") +
                           " inside tetrahedra of another one");
}

}  // namespace

void drop_repeated(Mesh& mesh)
{
  std::vector<std::pair<Tet, int>> by_corners;
  by_corners.reserve(mesh.tets.size());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    by_corners.emplace_back(mesh.tets[static_cast<std::size_t>(t)], t);
    std::sort(by_corners.back().first.begin(), by_corners.back().first.end());
  }
  std::sort(by_corners.begin(), by_corners.end());
  std::vector<bool> again(mesh.tets.size(), false);
  long long count = 0;
  for (std::size_t i = 1; i < by_corners.size(); ++i) {
    if (by_corners[i].first != by_corners[i - 1].first) continue;
    const int a = by_corners[i - 1].second, b = by_corners[i].second;
    const std::size_t in_a = static_cast<std::size_t>(mesh.region[static_cast<std::size_t>(a)]),
                      in_b = static_cast<std::size_t>(mesh.region[static_cast<std::size_t>(b)]);
    if (in_a != in_b)
      throw core::data_error(mesh.file + ": tetrahedra " + tag_of(mesh, a) + " and " +
                             tag_of(mesh, b) + " are the same one in two physical volumes, '" +
                             mesh.volumes[in_a] + "' and '" + mesh.volumes[in_b] + "'");
    again[static_cast<std::size_t>(b)] = true;
    ++count;
  }
  if (count == 0) return;
  const auto keep = [&](auto& list) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < list.size(); ++t)
      if (!again[t]) list[kept++] = list[t];
    list.resize(kept);
  };
  if (mesh.quadratic()) keep(mesh.middles);
  keep(mesh.tets);
  keep(mesh.region);
  keep(mesh.elem_tag);
  mesh.remarks.push_back(counted(count, "tetrahedron is", "tetrahedra are") +
                         " listed again: each counts once");
}

void judge(Mesh& mesh)
{
  const std::vector<Triangle> triangles = triangles_of(mesh);
  std::vector<bool> is_face(triangles.size(), false);
  std::size_t next = 0;  // index into `triangles`, which are sorted like the faces
  std::vector<TetFace> boundary;
  visit_faces(mesh, [&](std::span<const TetFace> same) {
    refuse_face(mesh, same);
    if (same.size() == 1) boundary.push_back(same.front());
    const Face& nodes = same.front().nodes;
    for (; next < triangles.size() && triangles[next].nodes <= nodes; ++next)
      is_face[next] = triangles[next].nodes == nodes;
  });
  sort_out(mesh, triangles, is_face);
  tell_of_edges(mesh, boundary);
  tell_of_coincident(mesh, boundary);
  judge_overlap(mesh, boundary);
}

}  // namespace trocar::mesh
