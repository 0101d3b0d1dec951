// What Gmsh's library reads, in a module of its own: see gmsh_reader.cpp.
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "core/failure.hpp"
#include "io/gmsh_reader.hpp"

namespace trocar::io {
namespace {

// Gmsh's element types, and which nodes in its order are ours.
constexpr int point_type = 15;
struct Order
{
  int line_type, triangle_type, tet_type;
  std::size_t line_nodes, triangle_nodes, tet_nodes;
};
constexpr Order linear{1, 2, 4, 2, 3, 4}, quadratic{8, 9, 11, 3, 6, 10};
constexpr std::array<std::size_t, 6> middles_in_gmsh{4, 5, 6, 7, 9, 8};

/// The Gmsh library between initialize and finalize, silent and ignorant of our command line.
class GmshSession
{
 public:
  GmshSession()
  {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

struct Group
{
  int dim, tag;
  std::string name;
};

std::vector<Group> physical_groups(int dim)
{
  const char* const kinds[] = {"point_", "curve_", "surface_", "volume_"};
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs, dim);
  std::vector<Group> groups;
  for (const auto& [d, tag] : pairs) {
    std::string name;
    gmsh::model::getPhysicalName(d, tag, name);
    if (name.empty()) name = kinds[d] + std::to_string(tag);
    groups.push_back({d, tag, name});
  }
  return groups;
}

/// Tags and node tags of all elements of one type in a group, nodes per element consecutive.
/// Throws Failure (65) for an element of another type in a volume group.
void elements_of(const std::string& file, const Group& group, int type,
                 std::vector<std::size_t>& tags, std::vector<std::size_t>& corners)
{
  std::vector<int> entities;
  gmsh::model::getEntitiesForPhysicalGroup(group.dim, group.tag, entities);
  for (int entity : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> element_tags, node_tags;
    gmsh::model::mesh::getElements(types, element_tags, node_tags, group.dim, entity);
    for (std::size_t k = 0; k < types.size(); ++k) {
      if (types[k] == type) {
        tags.insert(tags.end(), element_tags[k].begin(), element_tags[k].end());
        corners.insert(corners.end(), node_tags[k].begin(), node_tags[k].end());
      } else if (!element_tags[k].empty() && group.dim > 0 && group.dim < 3) {
        throw core::data_error(file + ": physical group '" + group.name + "' holds element " +
                               std::to_string(element_tags[k].front()) +
                               " of another order than the tetrahedra, or no simplex (Gmsh type " +
                               std::to_string(types[k]) + ")");
      } else if (!element_tags[k].empty() && group.dim == 3) {
        throw core::data_error(file + ": physical volume '" + group.name + "' holds element " +
                               std::to_string(element_tags[k].front()) +
                               " that is no tetrahedron of the mesh's order (Gmsh type " +
                               std::to_string(types[k]) + "; linear are 4, quadratic 11)");
      }
    }
  }
}

/// The order of the mesh's tets.
Order order_of_tets()
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, 3);
  const bool curved = std::find(types.begin(), types.end(), quadratic.tet_type) != types.end();
  return curved ? quadratic : linear;
}

struct RawTet
{
  std::size_t tag;
  std::vector<std::size_t> node;  ///< in Gmsh's order
  int region;
};

std::vector<RawTet> read_tets(mesh::Mesh& mesh, const Order& order)
{
  std::vector<RawTet> tets;
  for (const Group& group : physical_groups(3)) {
    std::vector<std::size_t> tags, nodes;
    elements_of(mesh.file, group, order.tet_type, tags, nodes);
    const int region = static_cast<int>(mesh.volumes.size());
    mesh.volumes.push_back(group.name);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const auto first = nodes.begin() + static_cast<std::ptrdiff_t>(order.tet_nodes * i);
      tets.push_back(
          {tags[i], {first, first + static_cast<std::ptrdiff_t>(order.tet_nodes)}, region});
    }
  }
  if (mesh.volumes.empty())
    throw core::data_error(mesh.file + ": no physical volume (is it a Gmsh mesh with tetrahedra?)");
  std::sort(tets.begin(), tets.end(),
            [](const RawTet& a, const RawTet& b) { return a.tag < b.tag; });
  for (std::size_t i = 1; i < tets.size(); ++i)
    if (tets[i].tag == tets[i - 1].tag)
      throw core::data_error(mesh.file + ": tetrahedron " + std::to_string(tets[i].tag) +
                             " is in two physical volumes, '" +
                             mesh.volumes[static_cast<std::size_t>(tets[i - 1].region)] +
                             "' and '" + mesh.volumes[static_cast<std::size_t>(tets[i].region)] +
                             "'");
  return tets;
}

using RowOfTag = std::map<std::size_t, int>;

RowOfTag number_nodes(mesh::Mesh& mesh, const std::vector<RawTet>& tets, double scale)
{
  std::set<std::size_t> used;
  for (const RawTet& tet : tets) used.insert(tet.node.begin(), tet.node.end());
  RowOfTag row_of;
  for (std::size_t tag : used) {
    row_of.emplace(tag, static_cast<int>(row_of.size()));
    mesh.node_tag.push_back(static_cast<long long>(tag));
  }
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parametric;
  gmsh::model::mesh::getNodes(tags, xyz, parametric);
  mesh.x.assign(used.size(), mesh::Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const auto row = row_of.find(tags[i]);
    if (row != row_of.end())
      mesh.x[static_cast<std::size_t>(row->second)] =
          scale * Eigen::Map<const mesh::Vec3>(&xyz[3 * i]);
  }
  return row_of;
}

void read_surfaces(mesh::Mesh& mesh, const RowOfTag& row_of, const Order& order)
{
  for (const Group& group : physical_groups(2)) {
    std::vector<std::size_t> tags, corners;
    elements_of(mesh.file, group, order.triangle_type, tags, corners);
    mesh::SurfaceGroup surface{group.name, {}};
    for (std::size_t i = 0; i < tags.size(); ++i) {
      mesh::Face face;
      bool known = true;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto row = row_of.find(corners[order.triangle_nodes * i + a]);
        known = known && row != row_of.end();
        if (known) face[a] = row->second;
      }
      if (!known)
        throw core::data_error(mesh.file + ": triangle " + std::to_string(tags[i]) +
                               " of surface '" + group.name + "' is not on any tetrahedron");
      surface.faces.push_back(face);
    }
    mesh.surfaces.push_back(std::move(surface));
  }
}

void read_points(mesh::Mesh& mesh, const RowOfTag& row_of)
{
  for (const Group& group : physical_groups(0)) {
    std::vector<std::size_t> tags, corners;
    elements_of(mesh.file, group, point_type, tags, corners);
    mesh::PointGroup points{group.name, {}, {}};
    for (std::size_t tag : corners) {
      const auto row = row_of.find(tag);
      if (row != row_of.end()) points.nodes.push_back(row->second);
    }
    std::sort(points.nodes.begin(), points.nodes.end());
    mesh.points.push_back(std::move(points));
  }
}

/// Curves are read as groups of points. One whose name a surface or a point has is left out: the
/// name keeps its meaning.
void read_curves(mesh::Mesh& mesh, const RowOfTag& row_of, const Order& order)
{
  const auto taken = [&](const std::string& name) {
    const auto has = [&](const auto& group) { return group.name == name; };
    return std::any_of(mesh.surfaces.begin(), mesh.surfaces.end(), has) ||
           std::any_of(mesh.points.begin(), mesh.points.end(), has);
  };
  for (const Group& group : physical_groups(1)) {
    if (taken(group.name)) continue;
    std::vector<std::size_t> tags, nodes;
    elements_of(mesh.file, group, order.line_type, tags, nodes);
    mesh::PointGroup curve{group.name, {}, {}};
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const auto a = row_of.find(nodes[order.line_nodes * i]);
      const auto b = row_of.find(nodes[order.line_nodes * i + 1]);
      for (const auto& end : {a, b})
        if (end != row_of.end()) curve.nodes.push_back(end->second);
      if (a != row_of.end() && b != row_of.end()) curve.edges.push_back({a->second, b->second});
    }
    std::sort(curve.nodes.begin(), curve.nodes.end());
    curve.nodes.erase(std::unique(curve.nodes.begin(), curve.nodes.end()), curve.nodes.end());
    mesh.points.push_back(std::move(curve));
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) ReadGmsh trocar_read_gmsh;

void trocar_read_gmsh(mesh::Mesh& mesh, double scale)
{
  const GmshSession session;
  // Gmsh 4.8 throws std::string, which no handler of std::exception sees.
  try {
    gmsh::open(mesh.file);
    const Order order = order_of_tets();
    const std::vector<RawTet> tets = read_tets(mesh, order);
    const RowOfTag row_of = number_nodes(mesh, tets, scale);
    for (const RawTet& tet : tets) {
      mesh::Tet corners;
      for (std::size_t a = 0; a < 4; ++a) corners[a] = row_of.at(tet.node[a]);
      mesh.tets.push_back(corners);
      if (tet.node.size() > 4) {
        mesh::Middles& middles = mesh.middles.emplace_back();
        for (std::size_t k = 0; k < 6; ++k) middles[k] = row_of.at(tet.node[middles_in_gmsh[k]]);
      }
      mesh.region.push_back(tet.region);
      mesh.elem_tag.push_back(static_cast<long long>(tet.tag));
    }
    read_surfaces(mesh, row_of, order);
    read_points(mesh, row_of);
    read_curves(mesh, row_of, order);
  } catch (const std::string& message) {
    throw core::data_error(mesh.file + ": Gmsh cannot read it: " + message);
  }
}

}  // namespace trocar::io
