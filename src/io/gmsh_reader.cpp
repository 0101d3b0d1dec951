#include "io/gmsh_reader.hpp"

#include <utility>

#include "io/msh_mesh.hpp"
#include "mesh/join.hpp"
#include "mesh/soundness.hpp"

namespace trocar::io {

namespace {

mesh::Mesh sound_mesh(const std::string& file, double scale)
{
  mesh::Mesh mesh = mesh_of(read_msh(file), scale);
  mesh::drop_repeated(mesh);
  mesh.index_middles();
  mesh::validate(mesh);
  mesh::judge(mesh);
  mesh.file_of.assign(mesh.volumes.size(), file);
  return mesh;
}

}  // namespace

mesh::Mesh read_gmsh(const std::string& file, double scale, const base::Comm& comm)
{
  return read_gmsh(std::vector{file}, scale, comm);
}

mesh::Mesh read_gmsh(const std::vector<std::string>& files, double scale, const base::Comm& comm)
{
  mesh::Mesh mesh;
  base::on_root(comm, [&] {
    std::vector<mesh::Mesh> parts;
    for (const std::string& file : files) parts.push_back(sound_mesh(file, scale));
    mesh = parts.size() == 1 ? std::move(parts.front()) : mesh::joined(parts);
  });
  mesh::broadcast(mesh, comm);
  return mesh;
}

}  // namespace trocar::io
