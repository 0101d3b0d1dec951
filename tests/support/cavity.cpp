#include "support/cavity.hpp"

#include <cmath>

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

driver::Scenario fluid_filled(mesh::Mesh mesh, const tissue::Material& material,
                              cavity::Model model)
{
  driver::Scenario scenario;
  scenario.mesh = std::move(mesh);
  scenario.time.analysis = driver::Analysis::equilibrium;
  scenario.tissue.model = tissue::Model::linear;
  scenario.tissue.materials = {material};
  cavity::CavitySettings one;
  one.name = "fluid";
  one.surface = "wall";
  one.model = model;
  scenario.cavities.cavities = {one};
  return scenario;
}

driver::Scenario cavity_scenario(int n, int hole, cavity::Model model, cavity::Solver solver)
{
  const double cell = 0.01, size = n * cell, half = 0.5 * hole * cell;
  const auto inside = [=](const core::Vec3& x) {
    return (x.array() - 0.5 * size).abs().maxCoeff() < half * (1.0 + 1e-9);
  };
  driver::Scenario scenario;
  scenario.mesh = block({n, n, n, core::Vec3::Constant(size), 0.0, inside});
  add_surface(scenario.mesh, "wall", inside);
  scenario.time.analysis = driver::Analysis::equilibrium;
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

}  // namespace trocar::test
