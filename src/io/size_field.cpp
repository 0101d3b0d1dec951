#include "io/size_field.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "base/files.hpp"
#include "core/failure.hpp"

namespace trocar::io {

/// True when there is no such file, or when it is a Gmsh view like those written below.
static bool may_be_replaced(const std::string& file)
{
  std::error_code trouble;
  const std::filesystem::file_type type = std::filesystem::symlink_status(file, trouble).type();
  if (type == std::filesystem::file_type::not_found) return true;
  if (type != std::filesystem::file_type::regular) return false;
  std::string begin(5, '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), 5);
  return begin == "View ";
}

void require_size_field(const std::string& file)
{
  const auto slash = file.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : file.substr(0, slash + 1);
  if (::access(folder.c_str(), W_OK) != 0)
    throw core::output_error("option -error_size_field: cannot write " + file);
  if (!may_be_replaced(file))
    throw core::output_error("option -error_size_field: " + file +
                             " is there and no size field: it is not replaced");
}

void write_size_field(const std::string& file, const mesh::Mesh& mesh, const core::VecX& sizes)
{
  if (!may_be_replaced(file))
    throw core::output_error("option -error_size_field: " + file +
                             " is there and no size field: it is not replaced");
  std::ostringstream text;
  text << std::setprecision(9) << "View \"edge length\" {\n";
  for (const mesh::Tet& tet : mesh.tets) {
    text << "SS(";
    for (std::size_t a = 0; a < 4; ++a) {
      const mesh::Vec3 x = mesh.x[static_cast<std::size_t>(tet[a])] / mesh.unit;
      text << (a ? "," : "") << x.x() << "," << x.y() << "," << x.z();
    }
    text << "){";
    for (std::size_t a = 0; a < 4; ++a) text << (a ? "," : "") << sizes[tet[a]] / mesh.unit;
    text << "};\n";
  }
  text << "};\n";
  base::replace_file(file, text.str());
}

}  // namespace trocar::io
