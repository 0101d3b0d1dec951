#include "mesh/skin.hpp"

#include <map>
#include <utility>

#include "core/failure.hpp"
#include "core/place.hpp"

namespace trocar::mesh {
namespace {

/// Every edge must be passed once each way.
void require_closed(const Skin& skin, const std::string& file)
{
  std::map<std::pair<int, int>, int> passed;
  for (const Face& face : skin.faces)
    for (std::size_t k = 0; k < 3; ++k) ++passed[{face[k], face[(k + 1) % 3]}];
  for (const auto& [edge, count] : passed) {
    const std::string place = "at " + core::shown(skin.x[static_cast<std::size_t>(edge.first)]);
    const auto back = passed.find({edge.second, edge.first});
    if (count > 1)
      throw core::data_error(file + ": an edge " + place +
                             " has two triangles on one side: they overlap, or are turned against "
                             "each other");
    if (back == passed.end())
      throw core::data_error(file + ": the surface is open " + place +
                             ": a rigid body needs a closed one");
  }
}

/// Every connected part must enclose a positive volume.
void require_right_side_out(const Skin& skin, const std::string& file)
{
  std::vector<std::size_t> part(skin.x.size());
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
  const auto root = [&](int corner) {
    auto i = static_cast<std::size_t>(corner);
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
  };
  for (const Face& face : skin.faces)
    for (std::size_t k = 1; k < 3; ++k) part[root(face[k])] = root(face[0]);
  std::map<std::size_t, double> six;  // times the volume of a part
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    const std::size_t of = root(skin.faces[f][0]);
    const Triangle at = skin.triangle(f);
    six[of] += (at[0] - skin.x[of]).dot((at[1] - skin.x[of]).cross(at[2] - skin.x[of]));
  }
  for (const auto& [of, volume] : six)
    if (!(volume > 0.0))
      throw core::data_error(file + ": the surface is inside out at " + core::shown(skin.x[of]) +
                             ": its triangles must be seen from outside in the positive sense");
}

}  // namespace

Triangle Skin::triangle(std::size_t f) const
{
  Triangle corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = x[static_cast<std::size_t>(faces[f][k])];
  return corners;
}

double Skin::volume() const
{
  double six = 0.0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle at = triangle(f);
    six += (at[0] - x[0]).dot((at[1] - x[0]).cross(at[2] - x[0]));
  }
  return six / 6.0;
}

Skin skin_of(const std::vector<Triangle>& triangles, const std::string& file)
{
  Skin skin;
  std::map<std::array<double, 3>, int> known;
  for (const Triangle& triangle : triangles) {
    Face face{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = triangle[k];
      const auto [at, fresh] =
          known.emplace(std::array{x.x(), x.y(), x.z()}, static_cast<int>(skin.x.size()));
      if (fresh) skin.x.push_back(x);
      face[k] = at->second;
    }
    const bool flat = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    if (!flat) skin.faces.push_back(face);  // triangles without area are common in such files
  }
  if (skin.faces.empty()) throw core::data_error(file + ": has no triangles");
  require_closed(skin, file);
  require_right_side_out(skin, file);
  return skin;
}

}  // namespace trocar::mesh
