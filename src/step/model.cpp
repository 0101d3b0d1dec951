#include "step/model.hpp"

#include <algorithm>

namespace trocar::step {

Model::Model(const Scene& of, const base::Comm& comm)
    : scene(of),
      space(of.mesh, mesh::partition_nodes(of.mesh, comm), comm,
            tissue::overlap_layers(of.tissue.dilatation)),
      tissue(of.mesh, space, of.tissue, ledger)
{
  if (scene.time.is_static || scene.time.start_in_equilibrium)
    tissue::require_supports(tissue.fixed(), scene.mesh);
  if (!scene.cavities.cavities.empty()) {
    cavities.emplace(scene.mesh, space, scene.cavities, ledger);
    pressure_search.emplace(*cavities, ledger);
  }
  contact = contact::pairs_of(scene.contact, scene.mesh, tissue.fixed());
  driven_at_start = !scene.tissue.boundary.displacements.empty() || cavities.has_value();
  for (const needle::NeedleSettings& settings : scene.needles) {
    needles.emplace_back(settings);
    driven_at_start =
        driven_at_start || settings.motion.inserted > 0.0 || settings.motion.trajectory;
  }
  if (needles.empty()) return;
  locator.emplace(scene.mesh);
  ground.emplace(scene.mesh, *locator, scene.insertion, scene.tissue.materials);
}

bool Model::beams() const
{
  return std::any_of(needles.begin(), needles.end(), [](const needle::Needle& one) {
    return one.settings().model == needle::Model::beam;
  });
}

bool Model::follows() const
{
  return cavities && cavities->follows();
}

bool Model::exact_volumes() const
{
  return cavities && cavities->exact();
}

cavity::Shape Model::walls(const fem::OwnedField& u) const
{
  return exact_volumes() ? cavities->shape(u) : cavity::Shape{};
}

void Model::drop_caches()
{
  tissue.drop_caches();
  if (cavities) pressure_search.emplace(*cavities, ledger);
}

}  // namespace trocar::step
