#include "support/bodies.hpp"

namespace trocar::test {
namespace {

void append(const mesh::Mesh& one, const std::string& prefix, mesh::Mesh& all)
{
  const int nodes = all.node_count(), tets = all.tet_count();
  const int volumes = static_cast<int>(all.volumes.size());
  all.x.insert(all.x.end(), one.x.begin(), one.x.end());
  for (mesh::Tet tet : one.tets) {
    for (int& node : tet) node += nodes;
    all.tets.push_back(tet);
  }
  for (mesh::Middles middles : one.middles) {
    for (int& node : middles) node += nodes;
    all.middles.push_back(middles);
  }
  for (int region : one.region) all.region.push_back(region + volumes);
  for (const std::string& volume : one.volumes) all.volumes.push_back(prefix + volume);
  for (mesh::SurfaceGroup surface : one.surfaces) {
    surface.name = prefix + surface.name;
    for (mesh::Face& face : surface.faces)
      for (int& node : face) node += nodes;
    all.surfaces.push_back(surface);
  }
  for (int n = 0; n < one.node_count(); ++n) all.node_tag.push_back(nodes + n + 1);
  for (int t = 0; t < one.tet_count(); ++t) all.elem_tag.push_back(tets + t + 1);
}

}  // namespace

mesh::Mesh joined(const mesh::Mesh& a, const mesh::Mesh& b)
{
  mesh::Mesh all;
  all.file = "test bodies";
  append(a, "a_", all);
  append(b, "b_", all);
  if (all.quadratic()) all.index_middles();
  return all;
}

}  // namespace trocar::test
