#include "io/stl.hpp"

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "core/failure.hpp"

namespace trocar::io {
namespace {

using core::Vec3;

constexpr std::size_t head = 84, record = 50;  ///< bytes of a binary file: header, triangle

std::uint32_t integer_at(const std::string& bytes, std::size_t place)
{
  static_assert(std::endian::native == std::endian::little, "STL is little-endian");
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

/// A text file may begin like a binary one and the other way round: the size decides.
bool is_binary(const std::string& bytes)
{
  return bytes.size() >= head && bytes.size() == head + record * integer_at(bytes, head - 4);
}

std::vector<mesh::Triangle> from_binary(const std::string& bytes, const std::string& file)
{
  std::vector<mesh::Triangle> triangles(integer_at(bytes, head - 4));
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 9; ++k) {
      const std::uint32_t bits = integer_at(bytes, head + record * t + 12 + 4 * k);
      const double value = std::bit_cast<float>(bits);
      if (!std::isfinite(value))
        throw core::data_error(file + ": triangle " + std::to_string(t + 1) +
                               " has a coordinate that is no number");
      triangles[t][k / 3][static_cast<Eigen::Index>(k % 3)] = value;
    }
  return triangles;
}

Vec3 vertex_of(const std::string& line, const std::string& where)
{
  std::istringstream words(line);
  std::string name, rest;
  Vec3 x;
  if (!(words >> name >> x[0] >> x[1] >> x[2]) || words >> rest || !x.allFinite())
    throw core::data_error(where + "expected 'vertex' and three numbers");
  return x;
}

std::string lower(std::string word)
{
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

std::vector<mesh::Triangle> from_text(const std::string& bytes, const std::string& file)
{
  std::vector<mesh::Triangle> triangles;
  std::istringstream text(bytes);
  std::size_t corners = 3, number = 0;  // of the last facet
  bool begun = false, ended = false;
  for (std::string line; std::getline(text, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    word = lower(word);
    const std::string where = file + ": line " + std::to_string(number) + ": ";
    if (!begun && word != "solid")
      throw core::data_error(file + ": is no STL file (neither text, nor binary of " +
                             std::to_string(bytes.size()) + " bytes)");
    begun = true;
    if (word == "vertex") {
      if (triangles.empty() || corners == 3)
        throw core::data_error(where + "a vertex outside of a facet of three");
      triangles.back()[corners++] = vertex_of(line, where);
      continue;
    }
    const bool closes = word == "facet" || word == "endfacet" || word == "endsolid";
    if (closes && corners != 3) throw core::data_error(where + "a facet without three vertices");
    if (word == "facet") {
      triangles.push_back({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
      corners = 0;
    }
    ended = ended || word == "endsolid";
  }
  if (!ended) throw core::data_error(file + ": is cut off: it has no 'endsolid'");
  return triangles;
}

}  // namespace

std::vector<mesh::Triangle> parse_stl(const std::string& bytes, const std::string& file)
{
  return is_binary(bytes) ? from_binary(bytes, file) : from_text(bytes, file);
}

}  // namespace trocar::io
