#include "support/tip.hpp"

namespace trocar::test {

step::Scene scene(double puncture, double cutting)
{
  step::Scene scenario = needle_scenario(distorted);
  scenario.insertion.friction = same({2.0, 2.0, 0.0});
  scenario.insertion.puncture.volume = {puncture};
  scenario.insertion.tip.cutting = {cutting};
  return scenario;
}

step::Scene layered()
{
  step::Scene scenario = needle_scenario({6, 4, 4, core::Vec3(0.06, 0.04, 0.04), 0.0});
  mesh::Mesh& mesh = scenario.mesh;
  mesh.volumes = {"soft", "stiff"};
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto corner = mesh::corners(mesh, t);
    const double x = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]).x();
    mesh.region[static_cast<std::size_t>(t)] = x > 0.03 ? 1 : 0;
  }
  scenario.tissue.materials = {{5000.0, 0.4, 1000.0, 0.0, 0.02}, {20000.0, 0.4, 1000.0, 0.0, 0.02}};
  scenario.insertion.friction = {{{1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}},
                                 {{4.0, 4.0, 0.0}, {4.0, 4.0, 0.0}}};
  scenario.insertion.tip.cutting = {0.05, 0.2};
  scenario.needles[0].motion.depth = 0.05;
  scenario.time.end = 3.0;
  return scenario;
}

}  // namespace trocar::test
