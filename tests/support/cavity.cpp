#include "support/cavity.hpp"

#include "mesh/topology.hpp"

namespace trocar::test {

void add_surface(mesh::Mesh& mesh, const std::string& name,
                 const std::function<bool(const core::Vec3&)>& on)
{
  mesh::SurfaceGroup surface{name, {}};
  for (const mesh::BoundaryFace& face : mesh::boundary_faces(mesh)) {
    bool all = true;
    for (int node : face.nodes) all = all && on(mesh.x[static_cast<std::size_t>(node)]);
    if (all) surface.faces.push_back(face.nodes);
  }
  mesh.surfaces.push_back(std::move(surface));
}

step::Scene fluid_filled(mesh::Mesh mesh, const tissue::Material& material, cavity::Model model)
{
  step::Scene scenario;
  scenario.mesh = std::move(mesh);
  scenario.time.is_static = true;
  scenario.tissue.model = tissue::Model::linear;
  scenario.tissue.materials = {material};
  cavity::CavitySettings one;
  one.name = "fluid";
  one.surface = "wall";
  one.model = model;
  scenario.cavities.cavities = {one};
  return scenario;
}

step::Scene cavity_scenario(int n, int hole, cavity::Model model, cavity::Solver solver)
{
  const double cell = 0.01, size = n * cell, half = 0.5 * hole * cell;
  const auto inside = [=](const core::Vec3& x) {
    return (x.array() - 0.5 * size).abs().maxCoeff() < half * (1.0 + 1e-9);
  };
  step::Scene scenario;
  scenario.mesh = block({n, n, n, core::Vec3::Constant(size), 0.0, inside});
  add_surface(scenario.mesh, "wall", inside);
  scenario.time.is_static = true;
  scenario.time.step = 0.1;
  scenario.tissue.model = tissue::Model::linear;
  scenario.tissue.materials = {{15000.0, 0.4, 1000.0, 0.0, 0.0}};
  scenario.tissue.boundary.fixed = {{"z0", 7}};
  cavity::CavitySettings one;
  one.name = "bladder";
  one.surface = "wall";
  one.model = model;
  one.solver = solver;
  scenario.cavities.cavities = {one};
  return scenario;
}

void press(step::Scene& scenario, double depth)
{
  scenario.tissue.boundary.displacements = {{"z1", core::Vec3(0.0, 0.0, -depth), std::nullopt}};
}

void add_needle(step::Scene& scenario, double y)
{
  step::Scene with = needle_scenario({});
  scenario.needles = with.needles;
  scenario.needles[0].motion.entry = core::Vec3(0.0, y, 0.0273);
  scenario.insertion = with.insertion;
  scenario.tissue.materials[0].rayleigh_stiffness = 0.02;
  scenario.time.is_static = false;
  scenario.time.step = 0.02;
  scenario.time.end = 1.0;
}

step::Outcome<step::Accepted> solved(step::Model& simulation)
{
  step::Outcome<step::Accepted> result = step::initial_state(simulation);
  if (!result) throw core::solver_error(result.why());
  return result;
}

step::StepReport solved(const step::Scene& scenario)
{
  step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
  return solved(simulation)->report;
}

}  // namespace trocar::test
