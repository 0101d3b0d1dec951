#include "gmsh_oracle.hpp"

#include <gmsh.h>

#include <algorithm>
#include <map>
#include <set>

namespace trocar::test {
namespace {

struct Found
{
  std::vector<std::size_t> tags, nodes;
};

Found elements_of(int dim, int group, int type)
{
  Found all;
  std::vector<int> entities;
  gmsh::model::getEntitiesForPhysicalGroup(dim, group, entities);
  for (int entity : entities) {
    std::vector<std::size_t> tags, nodes;
    gmsh::model::mesh::getElementsByType(type, tags, nodes, entity);
    all.tags.insert(all.tags.end(), tags.begin(), tags.end());
    all.nodes.insert(all.nodes.end(), nodes.begin(), nodes.end());
  }
  return all;
}

std::string name_of(int dim, int group)
{
  std::string name;
  gmsh::model::getPhysicalName(dim, group, name);
  return name;
}

std::vector<int> groups_of(int dim)
{
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs, dim);
  std::vector<int> tags;
  for (const auto& [d, tag] : pairs) tags.push_back(tag);
  return tags;
}

struct Tet
{
  std::size_t tag;
  std::vector<std::size_t> nodes;
  int region;
};

std::vector<Tet> tets(mesh::Mesh& mesh, int type, std::size_t nodes)
{
  std::vector<Tet> all;
  for (int group : groups_of(3)) {
    const Found found = elements_of(3, group, type);
    for (std::size_t i = 0; i < found.tags.size(); ++i) {
      const auto first = found.nodes.begin() + static_cast<std::ptrdiff_t>(nodes * i);
      all.push_back({found.tags[i],
                     {first, first + static_cast<std::ptrdiff_t>(nodes)},
                     static_cast<int>(mesh.volumes.size())});
    }
    mesh.volumes.push_back(name_of(3, group));
  }
  std::sort(all.begin(), all.end(), [](const Tet& a, const Tet& b) { return a.tag < b.tag; });
  return all;
}

}  // namespace

mesh::Mesh read_with_gmsh(const std::string& file, double scale)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(file);
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, 3);
  const bool curved = std::find(types.begin(), types.end(), 11) != types.end();
  mesh::Mesh mesh;
  const std::vector<Tet> all = tets(mesh, curved ? 11 : 4, curved ? 10 : 4);
  std::map<std::size_t, int> row;
  for (const Tet& tet : all)
    for (std::size_t node : tet.nodes) row[node] = 0;
  for (auto& [tag, number] : row) {
    number = static_cast<int>(mesh.x.size());
    std::vector<double> x, parametric;
    gmsh::model::mesh::getNode(tag, x, parametric);
    mesh.x.push_back(scale * Eigen::Map<const core::Vec3>(x.data()));
    mesh.node_tag.push_back(static_cast<long long>(tag));
  }
  for (const Tet& tet : all) {
    const auto& n = tet.nodes;
    mesh.tets.push_back({row.at(n[0]), row.at(n[1]), row.at(n[2]), row.at(n[3])});
    if (curved)
      mesh.middles.push_back(
          {row.at(n[4]), row.at(n[5]), row.at(n[6]), row.at(n[7]), row.at(n[9]), row.at(n[8])});
    mesh.region.push_back(tet.region);
    mesh.elem_tag.push_back(static_cast<long long>(tet.tag));
  }
  for (int group : groups_of(2)) {
    const Found found = elements_of(2, group, curved ? 9 : 2);
    mesh::SurfaceGroup surface{name_of(2, group), {}};
    for (std::size_t i = 0; i < found.tags.size(); ++i) {
      const std::size_t* const n = &found.nodes[(curved ? 6U : 3U) * i];
      surface.faces.push_back({row.at(n[0]), row.at(n[1]), row.at(n[2])});
    }
    mesh.surfaces.push_back(surface);
  }
  gmsh::finalize();
  return mesh;
}

}  // namespace trocar::test
