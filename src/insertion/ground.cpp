#include "insertion/ground.hpp"

#include <algorithm>
#include <utility>

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
  if (!along_line()) return;
  edges.emplace(mesh);
  int bodies = 0;
  body_of_node = mesh::connected_components(mesh, bodies);
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
