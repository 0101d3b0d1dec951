#include "io/gmsh_reader.hpp"

#include "io/msh_mesh.hpp"
#include "mesh/soundness.hpp"

namespace trocar::io {

mesh::Mesh read_gmsh(const std::string& file, double scale, const base::Comm& comm)
{
  mesh::Mesh mesh;
  base::on_root(comm, [&] {
    mesh = mesh_of(read_msh(file), scale);
    mesh::drop_repeated(mesh);
    mesh.index_middles();
    mesh::validate(mesh);
    mesh::judge(mesh);
  });
  mesh::broadcast(mesh, comm);
  return mesh;
}

}  // namespace trocar::io
