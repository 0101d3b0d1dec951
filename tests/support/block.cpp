#include "support/block.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::test {
namespace {

constexpr std::array<std::array<int, 4>, 6> kuhn{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// Reproducible number in (-1, 1).
double noise(int node, int axis)
{
  const double x = std::sin(12.9898 * node + 78.233 * (axis + 1)) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

void add_sides(mesh::Mesh& mesh, const core::Vec3& size)
{
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) {
      mesh::SurfaceGroup side{std::string(1, static_cast<char>('x' + axis)) + (end ? "1" : "0"),
                              {}};
      for (const auto& face : mesh::boundary_faces(mesh)) {
        bool on = true;
        for (int node : face.nodes)
          on = on && mesh.x[static_cast<std::size_t>(node)][axis] == end * size[axis];
        if (on) side.faces.push_back(face.nodes);
      }
      mesh.surfaces.push_back(side);
    }
}

}  // namespace

mesh::Mesh block(const BlockShape& shape)
{
  mesh::Mesh mesh;
  mesh.file = "test block";
  mesh.volumes = {"beam"};
  const std::array<int, 3> cells{shape.nx, shape.ny, shape.nz};
  std::map<int, int> row_of;  // grid node -> mesh node, only for nodes some cell uses
  const auto row = [&](int i, int j, int k) {
    const int grid = i + (shape.nx + 1) * (j + (shape.ny + 1) * k);
    const auto [entry, fresh] = row_of.emplace(grid, mesh.node_count());
    if (fresh) {
      core::Vec3 x;
      const std::array<int, 3> at{i, j, k};
      for (int a = 0; a < 3; ++a) {
        const auto c = static_cast<std::size_t>(a);
        const bool inner = at[c] > 0 && at[c] < cells[c];
        const double moved = at[c] + (inner ? shape.jitter * noise(grid, a) : 0.0);
        x[a] = shape.size[a] * (moved / cells[c]);  // exactly the size at the end
      }
      mesh.x.push_back(x);
      mesh.node_tag.push_back(grid + 1);
    }
    return entry->second;
  };
  for (int k = 0; k < shape.nz; ++k)
    for (int j = 0; j < shape.ny; ++j)
      for (int i = 0; i < shape.nx; ++i) {
        const core::Vec3 middle((i + 0.5) / shape.nx, (j + 0.5) / shape.ny, (k + 0.5) / shape.nz);
        if (shape.hole(middle.cwiseProduct(shape.size))) continue;
        for (const auto& pattern : kuhn) {
          mesh::Tet tet;
          for (std::size_t a = 0; a < 4; ++a) {
            const int c = pattern[a];
            tet[a] = row(i + c % 2, j + c / 2 % 2, k + c / 4);
          }
          mesh.tets.push_back(tet);
          if (mesh::tet_volume(mesh, mesh.tet_count() - 1) < 0.0)
            std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
          mesh.region.push_back(0);
          mesh.elem_tag.push_back(mesh.tet_count());
        }
      }
  add_sides(mesh, shape.size);
  if (shape.quadratic) mesh::make_quadratic(mesh);
  if (shape.map)
    for (core::Vec3& x : mesh.x) x = shape.map(x);
  return mesh;
}

}  // namespace trocar::test
