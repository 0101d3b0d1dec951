#include "driver/error_estimate.hpp"

#include <cmath>

#include "core/words.hpp"
#include "driver/stress_fields.hpp"

namespace trocar::driver {
namespace {

using core::VecX;
using Six = Eigen::Matrix<double, 6, 1>;

/// s : C⁻¹ : t of two stresses xx, yy, zz, xy, yz, xz [J/m³].
double complementary(const tissue::Material& m, const Six& s, const Six& t)
{
  const double product = s.head<3>().dot(t.head<3>()) + 2.0 * s.tail<3>().dot(t.tail<3>());
  return ((1.0 + m.poisson) * product - m.poisson * s.head<3>().sum() * t.head<3>().sum()) /
         m.young;
}

/// ∫ |Σ N_a d_a|² of the four nodal differences d_a, in the norm above; ∫ N_a N_b = V (1 + δ)/20.
double integral(const tissue::Material& m, const std::array<Six, 4>& d, double volume)
{
  Six sum = Six::Zero();
  double own = 0.0;
  for (const Six& one : d) {
    sum += one;
    own += complementary(m, one, one);
  }
  return volume / 20.0 * (complementary(m, sum, sum) + own);
}

}  // namespace

VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                     const VecX& stress)
{
  VecX errors = VecX::Zero(mesh.tet_count());
  for (int region = 0; region < static_cast<int>(materials.size()); ++region) {
    const VecX means = nodal_means(mesh, stress, region);
    for (int t = 0; t < mesh.tet_count(); ++t) {
      if (mesh.region[static_cast<std::size_t>(t)] != region) continue;
      std::array<Six, 4> d;
      for (std::size_t a = 0; a < 4; ++a) {
        const int node = mesh.tets[static_cast<std::size_t>(t)][a];
        d[a] = means.segment<6>(6 * node) - stress.segment<6>(6 * t);
      }
      errors[t] =
          integral(materials[static_cast<std::size_t>(region)], d, mesh::tet_volume(mesh, t));
    }
  }
  return errors;
}

void report_error(const Simulation& simulation, Recorder& recorder, const Log& log,
                  const State& state)
{
  const Scenario& scenario = simulation.scenario();
  const tissue::StressField found = simulation.tissue().stresses(state.tissue.u);
  const VecX errors = recovery_errors(scenario.mesh, scenario.tissue.materials, found.stress);
  std::vector<double> part(scenario.mesh.volumes.size(), 0.0);
  double energy = 0.0;  // squared energy norm: twice the energy
  for (int t = 0; t < scenario.mesh.tet_count(); ++t) {
    const auto at = static_cast<std::size_t>(t);
    part[static_cast<std::size_t>(scenario.mesh.region[at])] += errors[t];
    energy += 2.0 * found.energy[t] * mesh::tet_volume(scenario.mesh, t);
  }
  const double all = errors.sum();
  const double relative = all > 0.0 ? std::sqrt(all / (energy + all)) : 0.0;
  for (double& one : part) one = all > 0.0 ? one / all : 0.0;
  recorder.table(simulation, "/error_estimate/relative", {relative}, "1");
  recorder.table(simulation, "/error_estimate/part", part, "1");
  log.note("estimated error: " + core::shown(100.0 * relative) + " % of the energy norm");
  for (std::size_t v = 0; v < part.size(); ++v)
    log.note("  volume " + scenario.mesh.volumes[v] + ": " + core::shown(100.0 * part[v]) +
             " % of its square");
  const double target = scenario.output.error_target;
  if (target > 0.0 && relative > target)
    log.note("  for a target of " + core::shown(100.0 * target) + " % edges must be about " +
             core::shown(relative / target) + " times shorter (linear tets, smooth stress)");
}

}  // namespace trocar::driver
