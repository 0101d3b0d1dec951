#include "insertion/ground.hpp"

#include <algorithm>
#include <utility>

#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::insertion {

Ground::Ground(const mesh::Mesh& mesh_of, const mesh::Locator& locator_of,
               InsertionSettings settings_of, std::vector<tissue::Material> materials_of)
    : mesh(mesh_of),
      locator(locator_of),
      settings(std::move(settings_of)),
      materials(std::move(materials_of)),
      membranes(mesh_of, settings.puncture)
{
  settings.tip.cutting.resize(mesh.volumes.size(), 0.0);
  const auto& forces = settings.tip.cutting;
  resists = membranes.any() ||
            std::any_of(forces.begin(), forces.end(), [](double f) { return f > 0.0; });
  body_of_node = mesh::connected_components(mesh, bodies);
  if (along_line()) edges.emplace(mesh);
}

int Ground::tet_at(const Vec3& X, int near) const
{
  if (bodies < 2) return locator.tet_at(X);
  constexpr double tolerance = 1e-6;
  const Vec3 reach = Vec3::Constant(tolerance * mesh::mean_edge(mesh::corners(mesh, near)));
  for (int tet : locator.in_box(X - reach, X + reach))
    if (body(tet) == body(near) &&
        mesh::local_coordinates(mesh::positions(mesh, tet), X).minCoeff() >= -tolerance)
      return tet;
  return near;
}

double Ground::cutting(int tet) const
{
  if (tet < 0) return 0.0;
  return settings.tip.cutting[region(tet)];
}

const tissue::Material& Ground::material(int tet) const
{
  return materials[region(tet)];
}

double Ground::border(int from, int to, const Vec3& X) const
{
  const double membrane = membranes.threshold(from, to, X);
  return cutting(from) > 0.0 ? membrane : std::max(membrane, cutting(to));
}

}  // namespace trocar::insertion
