#include "step/model.hpp"

#include <algorithm>

namespace trocar::step {

Model::Model(const Scene& of, const base::Comm& comm)
    : scene(of),
      space(of.mesh, mesh::partition_nodes(of.mesh, comm), comm,
            tissue::overlap_layers(of.tissue.dilatation)),
      tissue(of.mesh, space, of.tissue, ledger)
{
  if (!scene.cavities.cavities.empty()) {
    cavities.emplace(scene.mesh, space, scene.cavities, ledger);
    pressure_search.emplace(*cavities, ledger);
  }
  contact = contact::pairs_of(scene.contact, scene.mesh, tissue.fixed());
  if (scene.time.is_static || scene.time.start_in_equilibrium) hold_bodies();
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

/// Whether a part of the mesh is on one side of a pair.
bool Model::in_contact(std::size_t body) const
{
  const auto touches = [&](const contact::Surface& surface) {
    return std::any_of(surface.corners().begin(), surface.corners().end(), [&](int node) {
      return bodies.of_node[static_cast<std::size_t>(node)] == static_cast<int>(body);
    });
  };
  return std::any_of(contact.begin(), contact.end(), [&](const contact::Pair& pair) {
    const auto* master = std::get_if<contact::Surface>(&pair.master);
    return touches(pair.slave) || (master && touches(*master));
  });
}

/// In statics supports hold every body, or contact does.
void Model::hold_bodies()
{
  bodies = tissue::bodies_of(scene.mesh, tissue.fixed());
  bool all = true;
  for (std::size_t b = 0; b < bodies.all.size(); ++b) {
    if (!bodies.all[b].held && !in_contact(b)) tissue::refuse_free(bodies, scene.mesh, b);
    all = all && bodies.all[b].held;
  }
  if (all)
    bodies = {};
  else
    proximal = tissue::small_inertia(bodies, scene.tissue.materials);
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
