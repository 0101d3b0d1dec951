#include "driver/locking_gauge.hpp"

#include "core/words.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::driver {

namespace {

/// dV/dp [m³/Pa] of every cavity's wall, the others left empty. Collective.
std::vector<double> wall_compliances(const mesh::Mesh& mesh, tissue::TissueSettings settings,
                                     const std::vector<cavity::CavitySettings>& cavities,
                                     const base::Comm& comm)
{
  settings.model = tissue::Model::linear;
  settings.pinned.clear();
  core::Ledger ledger;
  const fem::Space space(mesh, mesh::partition_nodes(mesh, comm), comm,
                         tissue::rings(settings.dilatation));
  tissue::Tissue tissue(mesh, space, std::move(settings), ledger);
  tissue::require_supports(tissue.fixed(), mesh);
  tissue.prepare({0.0, 1.0, true});
  std::vector<double> compliances;
  for (const cavity::CavitySettings& cavity : cavities) {
    const cavity::Wall wall(mesh, cavity.surface, cavity.caps);
    const fem::OwnedField push =
        wall.to_nodes(law::volume_gradient(wall.surface(), wall.undeformed()), space);
    compliances.push_back(space.dot(push, tissue.answer(push)));
  }
  return compliances;
}

}  // namespace

void report_locking(const Simulation& simulation, Recorder& recorder, const Log& log)
{
  const Scenario& scenario = simulation.scenario();
  const base::Comm& comm = simulation.space().comm();
  mesh::Mesh mesh = scenario.mesh;
  mesh::make_quadratic(mesh);
  tissue::TissueSettings reference = scenario.tissue;
  reference.dilatation = tissue::Dilatation::element;
  const auto& cavities = scenario.cavities.cavities;
  const std::vector<double> here = wall_compliances(scenario.mesh, scenario.tissue, cavities, comm);
  std::vector<double> ratios = wall_compliances(mesh, reference, cavities, comm);
  for (std::size_t i = 0; i < cavities.size(); ++i) {
    ratios[i] /= here[i];
    log.note("locking gauge: dP/dV of cavity '" + cavities[i].name + "' is " +
             core::shown(ratios[i]) + " times that of p2_bbar on this mesh");
  }
  recorder.table(simulation, "/locking_gauge/ratio", ratios, "1");
}

}  // namespace trocar::driver
