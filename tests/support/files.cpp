#include "support/files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <sstream>

namespace trocar::test {
namespace {

/// One line of a 2.2 file: an element of a physical group, by tags of nodes.
template <class Nodes>
void add_element(std::ostream& out, int tag, int type, std::size_t group, const Nodes& nodes,
                 const mesh::Mesh& mesh)
{
  out << tag << " " << type << " 2 " << group << " " << group;
  for (int node : nodes) out << " " << mesh.node_tag[static_cast<std::size_t>(node)];
  out << "\n";
}

std::string as_gmsh(const mesh::Mesh& mesh)
{
  std::ostringstream names, elements, out;
  int count = 0;
  for (std::size_t v = 0; v < mesh.volumes.size(); ++v)
    names << "3 " << v + 1 << " \"" << mesh.volumes[v] << "\"\n";
  for (std::size_t s = 0; s < mesh.surfaces.size(); ++s) {
    names << "2 " << mesh.volumes.size() + s + 1 << " \"" << mesh.surfaces[s].name << "\"\n";
    for (const mesh::Face& face : mesh.surfaces[s].faces)
      add_element(elements, ++count, 2, mesh.volumes.size() + s + 1, face, mesh);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    add_element(elements, ++count, 4, static_cast<std::size_t>(mesh.region[t]) + 1, mesh.tets[t],
                mesh);
  out << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
      << mesh.volumes.size() + mesh.surfaces.size() << "\n"
      << names.str() << "$EndPhysicalNames\n$Nodes\n"
      << mesh.x.size() << "\n";
  for (std::size_t i = 0; i < mesh.x.size(); ++i)
    out << mesh.node_tag[i] << " " << mesh.x[i].x() << " " << mesh.x[i].y() << " " << mesh.x[i].z()
        << "\n";
  out << "$EndNodes\n$Elements\n" << count << "\n" << elements.str() << "$EndElements\n";
  return out.str();
}

}  // namespace

std::string file_text(const std::string& path)
{
  std::ifstream stream(path);
  EXPECT_TRUE(stream) << "there is no file " << path;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string shared_text(const std::string& path, const std::string& text, const base::Comm& comm)
{
  base::on_root(comm, [&] { std::ofstream(path) << text; });
  return path;
}

std::string shared_mesh(const std::string& path, const mesh::Mesh& mesh, const base::Comm& comm)
{
  return shared_text(path, as_gmsh(mesh), comm);
}

}  // namespace trocar::test
