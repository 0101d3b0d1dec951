#pragma once

#include <string>
#include <vector>

#include "mesh/skin.hpp"

namespace trocar::io {

/// The triangles of an STL file, text or binary, in the file's unit; its normals are not read.
/// Throws Failure (65) naming the file, and the line or the triangle.
std::vector<mesh::Triangle> parse_stl(const std::string& bytes, const std::string& file);

}  // namespace trocar::io
