#include "support/bodies.hpp"

#include "mesh/join.hpp"

namespace trocar::test {
namespace {

mesh::Mesh prefixed(mesh::Mesh mesh, const std::string& prefix)
{
  for (std::string& volume : mesh.volumes) volume = prefix + volume;
  for (mesh::SurfaceGroup& surface : mesh.surfaces) surface.name = prefix + surface.name;
  for (mesh::PointGroup& point : mesh.points) point.name = prefix + point.name;
  return mesh;
}

}  // namespace

mesh::Mesh joined(const mesh::Mesh& a, const mesh::Mesh& b)
{
  mesh::Mesh all = mesh::joined({prefixed(a, "a_"), prefixed(b, "b_")});
  all.file = "test bodies";
  return all;
}

}  // namespace trocar::test
