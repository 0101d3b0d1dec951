#include "mesh/join.hpp"

#include <map>

#include "core/failure.hpp"
#include "core/fnv.hpp"

namespace trocar::mesh {
namespace {

/// Throws Failure (65) when two files have a group of one name, whatever its dimension.
void refuse_shared_names(const std::vector<Mesh>& parts)
{
  std::map<std::string, const Mesh*> known;
  for (const Mesh& part : parts) {
    const auto add = [&](const std::string& name) {
      const auto [at, fresh] = known.emplace(name, &part);
      if (!fresh && at->second != &part)
        throw core::data_error(part.file + ": '" + name + "' is a group of " + at->second->file +
                               " too: give one of them another name");
    };
    for (const std::string& volume : part.volumes) add(volume);
    for (const SurfaceGroup& surface : part.surfaces) add(surface.name);
    for (const PointGroup& point : part.points) add(point.name);
  }
}

void append(const Mesh& part, Mesh& all)
{
  const int first = all.node_count();
  const int volumes = static_cast<int>(all.volumes.size());
  all.x.insert(all.x.end(), part.x.begin(), part.x.end());
  all.node_tag.insert(all.node_tag.end(), part.node_tag.begin(), part.node_tag.end());
  all.elem_tag.insert(all.elem_tag.end(), part.elem_tag.begin(), part.elem_tag.end());
  all.volumes.insert(all.volumes.end(), part.volumes.begin(), part.volumes.end());
  all.file_of.insert(all.file_of.end(), part.file_of.begin(), part.file_of.end());
  const auto shift = [first](auto nodes) {
    for (int& node : nodes) node += first;
    return nodes;
  };
  for (const Tet& tet : part.tets) all.tets.push_back(shift(tet));
  for (const Middles& middles : part.middles) all.middles.push_back(shift(middles));
  for (int region : part.region) all.region.push_back(region + volumes);
  for (SurfaceGroup surface : part.surfaces) {
    for (Face& face : surface.faces) face = shift(face);
    all.surfaces.push_back(std::move(surface));
  }
  for (PointGroup point : part.points) {
    point.nodes = shift(point.nodes);
    for (std::array<int, 2>& edge : point.edges) edge = shift(edge);
    all.points.push_back(std::move(point));
  }
  for (const std::string& remark : part.remarks) all.remarks.push_back(part.file + ": " + remark);
}

}  // namespace

Mesh joined(const std::vector<Mesh>& parts)
{
  refuse_shared_names(parts);
  Mesh all;
  all.unit = parts.front().unit;
  std::string hashes;
  for (const Mesh& part : parts) {
    if (part.quadratic() != parts.front().quadratic())
      throw core::data_error(part.file +
                             ": linear and quadratic tets cannot be in one scene, and " +
                             parts.front().file + " has the others");
    all.file += (all.file.empty() ? "" : ",") + part.file;
    hashes += part.hash;
    append(part, all);
  }
  all.hash = core::fnv1a(hashes);
  all.index_middles();
  return all;
}

}  // namespace trocar::mesh
