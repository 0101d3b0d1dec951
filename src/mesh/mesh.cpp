#include "mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/words.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::mesh {
namespace {

std::vector<std::string> surface_names(const Mesh& mesh)
{
  std::vector<std::string> names;
  for (const SurfaceGroup& group : mesh.surfaces) names.push_back(group.name);
  return names;
}

/// Failure (65) for a name that no group of this kind has. Suggests the nearest of `names`; lists
/// all of them where the name is that of a volume.
core::Failure no_group(const Mesh& mesh, const std::string& kind, const std::string& name,
                       const std::vector<std::string>& names)
{
  const bool volume =
      std::find(mesh.volumes.begin(), mesh.volumes.end(), name) != mesh.volumes.end();
  if (!volume)
    return core::data_error(mesh.file + ": no physical " + kind + " '" + name + "'" +
                            core::did_you_mean(name, names));
  return core::data_error(mesh.file + ": '" + name + "' is a volume, a physical " + kind +
                          " is wanted: " + (names.empty() ? "there is none" : core::join(names)));
}

void check_middles(const Mesh& mesh)
{
  for (std::size_t t = 0; t < mesh.middles.size(); ++t)
    for (std::size_t k = 0; k < 6; ++k)
      if (mesh.middle_of(mesh.tets[t][tet_edges[k][0]], mesh.tets[t][tet_edges[k][1]]) !=
          mesh.middles[t][k])
        throw core::data_error(mesh.file + ": tetrahedron " + std::to_string(mesh.elem_tag[t]) +
                               " and a neighbour have different middle nodes on an edge");
}

}  // namespace

void Mesh::index_middles()
{
  middle_of_edge.clear();
  for (std::size_t t = 0; t < middles.size(); ++t)
    for (std::size_t k = 0; k < 6; ++k)
      middle_of_edge[edge_key(tets[t][tet_edges[k][0]], tets[t][tet_edges[k][1]])] = middles[t][k];
}

double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

double corner_volume(const Mesh& mesh, int tet)
{
  const auto p = corners(mesh, tet);
  return tet_volume(p[0], p[1], p[2], p[3]);
}

double tet_volume(const Mesh& mesh, int tet)
{
  return mesh.quadratic() ? curved_volume(positions(mesh, tet)) : corner_volume(mesh, tet);
}

std::array<Vec3, 4> corners(const Mesh& mesh, int tet)
{
  const Tet& t = mesh.tets[static_cast<std::size_t>(tet)];
  std::array<Vec3, 4> corner;
  for (std::size_t a = 0; a < 4; ++a) corner[a] = mesh.x[static_cast<std::size_t>(t[a])];
  return corner;
}

Eigen::Vector4d barycentric(const std::array<Vec3, 4>& corner, const Vec3& p)
{
  core::Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = corner[static_cast<std::size_t>(a) + 1] - corner[0];
  const Vec3 b = D.inverse() * (p - corner[0]);
  return {1.0 - b.sum(), b[0], b[1], b[2]};
}

double mean_edge(const std::array<Vec3, 4>& corner)
{
  double sum = 0.0;
  for (const auto& [a, b] : tet_edges) sum += (corner[b] - corner[a]).norm();
  return sum / 6.0;
}

double longest_edge(const std::array<Vec3, 4>& corner)
{
  double longest = 0.0;
  for (const auto& [a, b] : tet_edges) longest = std::max(longest, (corner[b] - corner[a]).norm());
  return longest;
}

const SurfaceGroup& surface_group(const Mesh& mesh, const std::string& name)
{
  for (const SurfaceGroup& group : mesh.surfaces) {
    if (group.name != name) continue;
    if (group.strays.empty()) return group;
    throw core::data_error(
        mesh.file + ": surface '" + name + "' has " + std::to_string(group.strays.size()) +
        " triangles that are no face of a tetrahedron: " + core::listed(group.strays));
  }
  throw no_group(mesh, "surface", name, surface_names(mesh));
}

std::vector<int> group_nodes(const Mesh& mesh, const std::string& name)
{
  for (const PointGroup& group : mesh.points) {
    if (group.name != name) continue;
    if (group.nodes.empty())
      throw core::data_error(mesh.file + ": no point of physical group '" + name +
                             "' is on a tetrahedron");
    std::vector<int> nodes = group.nodes;
    for (const auto& [a, b] : group.edges)
      if (mesh.quadratic() && mesh.has_edge(a, b)) nodes.push_back(mesh.middle_of(a, b));
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }
  std::vector<std::string> names = surface_names(mesh);
  for (const PointGroup& group : mesh.points) names.push_back(group.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw no_group(mesh, "surface, curve or point", name, names);
  std::vector<int> nodes;
  for (const Face& face : surface_group(mesh, name).faces)
    for (int node : nodes_of(mesh, face)) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void validate(const Mesh& mesh)
{
  const std::string mending =
      ": gmsh -optimize_ho mends it, in a .geo file Mesh.HighOrderOptimize = 2;";
  check_middles(mesh);
  if (mesh.tets.empty())
    throw core::data_error(mesh.file + ": no tetrahedra in any physical volume");
  for (int i = 0; i < mesh.node_count(); ++i)
    if (!mesh.x[static_cast<std::size_t>(i)].allFinite())
      throw core::data_error(mesh.file + ": node " +
                             std::to_string(mesh.node_tag[static_cast<std::size_t>(i)]) +
                             " has a coordinate that is not finite");
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double volume = corner_volume(mesh, t);
    const double edge = longest_edge(corners(mesh, t));
    const bool folded = volume > 0.0 && smallest_jacobian(positions(mesh, t)) <= 0.0;
    if (volume > 1e-12 * edge * edge * edge && !folded) continue;
    throw core::data_error(mesh.file + ": tetrahedron " +
                           std::to_string(mesh.elem_tag[static_cast<std::size_t>(t)]) +
                           (volume < 0 ? " is inverted"
                            : folded   ? " is folded by its curved edges"
                                       : " is flat") +
                           " (volume " + core::shown(volume) + " m^3)" + (folded ? mending : ""));
  }
}

Quality quality(const Mesh& mesh)
{
  Quality report;
  report.smallest = std::numeric_limits<double>::infinity();
  report.shortest_edge = report.smallest;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto p = corners(mesh, t);
    double squares = 0.0;
    for (const auto& [a, b] : tet_edges) {
      const double edge = (p[b] - p[a]).norm();
      squares += edge * edge;
      report.shortest_edge = std::min(report.shortest_edge, edge);
      report.longest_edge = std::max(report.longest_edge, edge);
    }
    const double q = 6.0 * std::sqrt(2.0) * corner_volume(mesh, t) / std::pow(squares / 6.0, 1.5);
    report.mean += q / mesh.tet_count();
    report.volume += tet_volume(mesh, t);
    if (q < report.smallest) {
      report.smallest = q;
      report.worst_tag = mesh.elem_tag[static_cast<std::size_t>(t)];
    }
  }
  return report;
}

}  // namespace trocar::mesh
