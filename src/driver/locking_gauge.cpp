#include "driver/locking_gauge.hpp"

#include "core/words.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::driver {

double wall_compliance(const mesh::Mesh& mesh, const tissue::TissueSettings& settings,
                       const cavity::CavitySettings& cavity, const base::Comm& comm)
{
  tissue::TissueSettings at_rest = settings;
  at_rest.model = tissue::Model::linear;
  at_rest.pinned.clear();
  core::Ledger ledger;  // not of the run
  const fem::Space space(mesh, mesh::partition_nodes(mesh, comm), comm,
                         tissue::rings(at_rest.dilatation));
  tissue::Tissue tissue(mesh, space, at_rest, ledger);
  tissue::require_supports(tissue.fixed(), mesh);
  tissue.prepare({0.0, 1.0, true});
  const cavity::Wall wall(mesh, cavity.surface, cavity.caps);
  const fem::OwnedField push =
      wall.to_nodes(law::volume_gradient(wall.surface(), wall.undeformed()), space);
  return space.dot(push, tissue.answer(push));
}

void report_locking(const Simulation& simulation, Recorder& recorder, const Log& log)
{
  const Scenario& scenario = simulation.scenario();
  const base::Comm& comm = simulation.space().comm();
  mesh::Mesh mesh = scenario.mesh;
  mesh::make_quadratic(mesh);
  tissue::TissueSettings reference = scenario.tissue;
  reference.dilatation = tissue::Dilatation::nodal;
  std::vector<double> ratios;
  for (const cavity::CavitySettings& cavity : scenario.cavities.cavities) {
    const double here = wall_compliance(scenario.mesh, scenario.tissue, cavity, comm);
    ratios.push_back(wall_compliance(mesh, reference, cavity, comm) / here);
    log.note("locking gauge: dP/dV of cavity '" + cavity.name + "' is " +
             core::shown(ratios.back()) + " times that of p2_anp on this mesh");
  }
  recorder.table(simulation, "/locking_gauge/ratio", ratios, "1");
}

}  // namespace trocar::driver
