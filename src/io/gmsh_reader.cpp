#include "io/gmsh_reader.hpp"

#include <dlfcn.h>

#include <cstdint>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "core/failure.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::io {
namespace {

/// FNV-1a of the bytes, as 16 hexadecimal digits.
std::string file_hash(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t hash = 14695981039346656037ULL;
  for (char byte; stream.get(byte);)
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << hash;
  return text.str();
}

/// The module around Gmsh's library, loaded when the first mesh is read and kept. With the modeller
/// behind it, it takes twice as long to load as PETSc: only a rank that reads pays.
/// RTLD_DEEPBIND has it find its names in itself first: quicker, and never our Eigen, which is
/// compiled for another CPU. Sanitizers cannot have that.
ReadGmsh* gmsh_module()
{
#ifdef __SANITIZE_ADDRESS__
  constexpr int mode = RTLD_LAZY | RTLD_LOCAL;
#else
  constexpr int mode = RTLD_LAZY | RTLD_LOCAL | RTLD_DEEPBIND;
#endif
  void* module = dlopen("libtrocar_gmsh.so", mode);
  void* read = module ? dlsym(module, "trocar_read_gmsh") : nullptr;
  if (!read)
    throw core::Failure(core::ExitCode::internal,
                        std::string("the mesh reader cannot be loaded: ") + dlerror());
  return reinterpret_cast<ReadGmsh*>(read);
}

void read_on_root(mesh::Mesh& mesh, double scale)
{
  std::ifstream probe(mesh.file, std::ios::binary);
  if (!probe)
    throw core::data_error(mesh.file +
                           ": no such mesh file (scripts/build makes those of meshes/)");
  if (probe.peek() == std::ifstream::traits_type::eof())
    throw core::data_error(mesh.file + ": the mesh file is empty");
  mesh.hash = file_hash(mesh.file);
  static ReadGmsh* const read = gmsh_module();
  read(mesh, scale);
  mesh.index_middles();
  mesh::validate(mesh);
  mesh::check_surface_edges(mesh);
}

}  // namespace

mesh::Mesh read_gmsh(const std::string& file, double scale, const base::Comm& comm)
{
  mesh::Mesh mesh;
  mesh.file = file;
  base::on_root(comm, [&] { read_on_root(mesh, scale); });
  mesh::broadcast(mesh, comm);
  return mesh;
}

}  // namespace trocar::io
