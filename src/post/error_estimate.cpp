#include "post/error_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "fem/shape.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::post {
namespace {

/// s : C⁻¹ : t of two stresses with components xx, yy, zz, xy, yz, xz [J/m³].
double complementary(const tissue::Material& m, const Voigt& s, const Voigt& t)
{
  const double product = s.head<3>().dot(t.head<3>()) + 2.0 * s.tail<3>().dot(t.tail<3>());
  return ((1.0 + m.poisson) * product - m.poisson * s.head<3>().sum() * t.head<3>().sum()) /
         m.young;
}

/// ∫ d : C⁻¹ : d dV over a tet [J] of the stress difference d = Σ N_a d_a with nodal values d_a.
/// Exact for straight tets.
template <int N>
double integral(const tissue::Material& m, const NodalStress& d, double volume)
{
  static const Eigen::Matrix<double, N, N> mass = fem::straight_mass<N>();
  double sum = 0.0;
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) sum += mass(a, b) * complementary(m, d.col(a), d.col(b));
  return volume * sum;
}

}  // namespace

VecX recovery_errors(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                     const tissue::StressField& field)
{
  VecX errors = VecX::Zero(mesh.tet_count());
  for (int region = 0; region < static_cast<int>(materials.size()); ++region) {
    const VecX means = nodal_means(mesh, field, region);
    for (int t = 0; t < mesh.tet_count(); ++t) {
      if (mesh.region[static_cast<std::size_t>(t)] != region) continue;
      NodalStress d = -stress_at_nodes(mesh, field, t);
      Eigen::Index a = 0;
      for (int node : mesh::nodes_of(mesh, t)) d.col(a++) += means.segment<6>(6 * node);
      const tissue::Material& m = materials[static_cast<std::size_t>(region)];
      const double volume = mesh::tet_volume(mesh, t);
      errors[t] = mesh.quadratic() ? integral<10>(m, d, volume) : integral<4>(m, d, volume);
    }
  }
  return errors;
}

VecX wanted_sizes(const mesh::Mesh& mesh, const VecX& errors, double energy, double target)
{
  constexpr double finest = 0.25, coarsest = 2.0;
  constexpr double edge_over_size = 1.2;  // mean edge of Gmsh's mesh over the requested size
  const double p = mesh.quadratic() ? 2.0 : 1.0, d = 3.0;
  double sum = 0.0;
  for (double square : errors) sum += std::pow(square, d / (2.0 * p + d));
  const double common = std::pow(target * target * energy / sum, 0.5 / p);
  VecX logs = VecX::Zero(mesh.node_count()), weight = logs, edge(mesh.tet_count());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    edge[t] = mesh::mean_edge(mesh::corners(mesh, t));
    const double ratio = common * std::pow(errors[t], -1.0 / (2.0 * p + d));
    const double volume = mesh::tet_volume(mesh, t);
    for (int node : mesh::nodes_of(mesh, t)) {
      logs[node] += volume * std::log(edge[t] * std::clamp(ratio, finest, coarsest));
      weight[node] += volume;
    }
  }
  VecX size = (logs.array() / weight.array()).exp();
  // Averaging at the nodes loses part of the contrast between sizes, so the error misses the
  // target. All sizes are scaled until the error predicted from them is the target.
  double predicted = 0.0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    double here = 0.0;
    for (int node : mesh.tets[static_cast<std::size_t>(t)]) here += 0.25 * size[node];
    predicted += errors[t] * std::pow(here / edge[t], 2.0 * p);
  }
  size *= std::pow(target * target * energy / predicted, 0.5 / p) / edge_over_size;
  return size;
}

ErrorEstimate estimate_error(const mesh::Mesh& mesh, const std::vector<tissue::Material>& materials,
                             const tissue::StressField& field)
{
  ErrorEstimate estimate{recovery_errors(mesh, materials, field)};
  estimate.part.assign(mesh.volumes.size(), 0.0);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto region = static_cast<std::size_t>(mesh.region[static_cast<std::size_t>(t)]);
    estimate.part[region] += estimate.errors[t];
    estimate.energy += 2.0 * field.energy[t] * mesh::tet_volume(mesh, t);
  }
  const double all = estimate.sum();
  estimate.relative = all > 0.0 ? std::sqrt(all / (estimate.energy + all)) : 0.0;
  for (double& one : estimate.part) one = all > 0.0 ? one / all : 0.0;
  return estimate;
}

}  // namespace trocar::post
