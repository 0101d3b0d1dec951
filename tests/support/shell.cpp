#include "support/shell.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/quadratic.hpp"

namespace trocar::test {
namespace {

using core::Vec3;

/// Prisms between layers of a triangulated surface, three tets each; split by the order of the
/// vertices, so that neighbours agree.
mesh::Mesh layered(const std::vector<std::vector<Vec3>>& layer, const std::vector<mesh::Face>& face)
{
  mesh::Mesh mesh;
  mesh.file = "test shell";
  mesh.volumes = {"shell"};
  const int n = static_cast<int>(layer.front().size());
  for (const auto& points : layer)
    for (const Vec3& x : points) {
      mesh.x.push_back(x);
      mesh.node_tag.push_back(mesh.node_count());
    }
  for (int k = 0; k + 1 < static_cast<int>(layer.size()); ++k)
    for (mesh::Face f : face) {
      std::sort(f.begin(), f.end());
      const int a = k * n + f[0], b = k * n + f[1], c = k * n + f[2];
      for (mesh::Tet tet :
           {mesh::Tet{a, b, c, c + n}, {a, b, b + n, c + n}, {a, a + n, b + n, c + n}}) {
        mesh.tets.push_back(tet);
        if (mesh::tet_volume(mesh, mesh.tet_count() - 1) < 0.0)
          std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
        mesh.region.push_back(0);
        mesh.elem_tag.push_back(mesh.tet_count());
      }
    }
  const int last = (static_cast<int>(layer.size()) - 1) * n;
  mesh.surfaces = {{"wall", face}, {"outer", face}};
  for (mesh::Face& f : mesh.surfaces[1].faces)
    for (int& node : f) node += last;
  return mesh;
}

std::vector<double> radii(int layers, double inner, double outer)
{
  std::vector<double> r;
  for (int k = 0; k <= layers; ++k)
    r.push_back(inner * std::pow(outer / inner, static_cast<double>(k) / layers));
  return r;
}

void add_axis_points(mesh::Mesh& mesh, double outer, int axes)
{
  for (int axis = 0; axis < axes; ++axis) {
    mesh::PointGroup group{std::string("on_") + static_cast<char>('x' + axis), {}, {}};
    for (int i = 0; i < mesh.node_count(); ++i) {
      Vec3 x = mesh.x[static_cast<std::size_t>(i)];
      if (axes == 2) x.z() = 0.0;
      if (std::abs(std::abs(x[axis]) - outer) < 1e-9 * outer) group.nodes.push_back(i);
    }
    mesh.points.push_back(group);
  }
}

}  // namespace

SphereSurface sphere_surface(int levels)
{
  SphereSurface s{
      {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()},
      {}};
  for (int a : {0, 1})
    for (int b : {2, 3})
      for (int c : {4, 5}) {
        const bool out = (a + b + c) % 2 == 0;
        s.face.push_back(out ? mesh::Face{a, b, c} : mesh::Face{a, c, b});
      }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> known;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = known.emplace(std::minmax(a, b), static_cast<int>(s.point.size()));
      if (fresh)
        s.point.push_back(
            (s.point[static_cast<std::size_t>(a)] + s.point[static_cast<std::size_t>(b)])
                .normalized());
      return at->second;
    };
    std::vector<mesh::Face> finer;
    for (const mesh::Face& f : s.face) {
      const int ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {ab, f[1], bc}, {ca, bc, f[2]}, {ab, bc, ca}});
    }
    s.face = finer;
  }
  return s;
}

mesh::Mesh shell(int levels, int layers, double inner, double outer)
{
  const SphereSurface sphere = sphere_surface(levels);
  std::vector<std::vector<Vec3>> layer;
  for (double r : radii(layers, inner, outer)) {
    std::vector<Vec3> points;
    for (const Vec3& x : sphere.point) points.emplace_back(r * x);
    layer.push_back(points);
  }
  mesh::Mesh mesh = layered(layer, sphere.face);
  add_axis_points(mesh, outer, 3);
  return mesh;
}

void make_round(mesh::Mesh& mesh)
{
  mesh::make_quadratic(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 0; k < 6; ++k) {
      const auto end = [&](std::size_t i) {
        return mesh.x[static_cast<std::size_t>(mesh.tets[t][mesh::tet_edges[k][i]])];
      };
      Vec3& middle = mesh.x[static_cast<std::size_t>(mesh.middles[t][k])];
      middle = 0.5 * (end(0).norm() + end(1).norm()) * middle.normalized();
    }
}

mesh::Mesh tube(int around, int along, int layers, double inner, double outer, double height)
{
  std::vector<mesh::Face> face;
  const auto at = [&](int i, int j) { return (i % around) + around * j; };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      face.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      face.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  std::vector<std::vector<Vec3>> layer;
  for (double r : radii(layers, inner, outer)) {
    std::vector<Vec3> points;
    for (int j = 0; j <= along; ++j)
      for (int i = 0; i < around; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / around;
        points.emplace_back(r * std::cos(angle), r * std::sin(angle), height * j / along);
      }
    layer.push_back(points);
  }
  mesh::Mesh mesh = layered(layer, face);
  mesh::PointGroup ends{"ends", {}, {}};
  for (int i = 0; i < mesh.node_count(); ++i) {
    const double z = mesh.x[static_cast<std::size_t>(i)].z();
    if (z == 0.0 || z == height) ends.nodes.push_back(i);
  }
  mesh.points.push_back(ends);
  add_axis_points(mesh, outer, 2);
  return mesh;
}

}  // namespace trocar::test
