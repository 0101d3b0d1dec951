#include "post/locking_gauge.hpp"

#include "cavity/wall.hpp"
#include "mesh/partition.hpp"
#include "mesh/quadratic.hpp"
#include "tissue/bodies.hpp"

namespace trocar::post {

namespace {

/// dV/dp [m³/Pa] of every cavity's wall, with no pressure in the other cavities. Collective.
std::vector<double> wall_compliances(const mesh::Mesh& mesh, tissue::TissueSettings settings,
                                     const std::vector<cavity::CavitySettings>& cavities,
                                     const base::Comm& comm)
{
  settings.model = tissue::Model::linear;
  for (tissue::Material& material : settings.materials) material.model.reset();
  settings.ordered_last.clear();
  core::Ledger ledger;
  const fem::Space space(mesh, mesh::partition_nodes(mesh, comm), comm,
                         tissue::overlap_layers(settings.dilatation));
  tissue::Tissue tissue(mesh, space, std::move(settings), ledger);
  tissue::require_supports(tissue.fixed(), mesh);
  tissue.prepare(core::TimeStep::at_start(1.0));
  std::vector<double> compliances;
  for (const cavity::CavitySettings& cavity : cavities) {
    const cavity::Wall wall(mesh, cavity.surface, cavity.caps);
    const fem::OwnedField push =
        wall.to_nodes(law::volume_gradient(wall.surface(), wall.undeformed()), space);
    compliances.push_back(space.dot(push, tissue.factor().answer(push)));
  }
  return compliances;
}

}  // namespace

std::vector<double> locking_ratios(const step::Scene& scene, const base::Comm& comm)
{
  mesh::Mesh mesh = scene.mesh;
  mesh::make_quadratic(mesh);
  tissue::TissueSettings reference = scene.tissue;
  reference.dilatation = tissue::Dilatation::element;
  const auto& cavities = scene.cavities.cavities;
  const std::vector<double> here = wall_compliances(scene.mesh, scene.tissue, cavities, comm);
  std::vector<double> ratios = wall_compliances(mesh, reference, cavities, comm);
  for (std::size_t i = 0; i < cavities.size(); ++i) ratios[i] /= here[i];
  return ratios;
}

}  // namespace trocar::post
