#include "io/size_field.hpp"

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "io/results.hpp"

namespace trocar::io {

void require_size_field(const std::string& file)
{
  const std::string temporary = file + ".tmp";
  if (!std::ofstream(temporary))
    throw core::output_error("option -error_size_field: cannot write " + temporary);
  std::remove(temporary.c_str());
}

void write_size_field(const std::string& file, const mesh::Mesh& mesh, const core::VecX& sizes)
{
  std::ostringstream text;
  text << std::setprecision(9) << "View \"edge length\" {\n";
  for (const mesh::Tet& tet : mesh.tets) {
    text << "SS(";
    for (std::size_t a = 0; a < 4; ++a) {
      const mesh::Vec3& x = mesh.x[static_cast<std::size_t>(tet[a])];
      text << (a ? "," : "") << x.x() << "," << x.y() << "," << x.z();
    }
    text << "){";
    for (std::size_t a = 0; a < 4; ++a) text << (a ? "," : "") << sizes[tet[a]];
    text << "};\n";
  }
  text << "};\n";
  write_atomically(file, text.str());
}

}  // namespace trocar::io
