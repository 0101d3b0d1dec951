#include "driver/stress_fields.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "core/dense.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::driver {
namespace {

using core::VecX;
using Six = Eigen::Matrix<double, 6, 1>;

io::Field field(const std::string& name, std::size_t columns, const std::string& units,
                const VecX& values, bool nodal)
{
  return {name,  columns, units, {values.data(), values.data() + values.size()},
          nodal, false,   !nodal};
}

}  // namespace

double von_mises(const Six& s)
{
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * s.tail<3>().squaredNorm());
}

Vec3 principal_values(const Six& s)
{
  core::Mat3 tensor;
  tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return core::symmetric_eigenvalues(tensor).reverse();
}

NodalStress stress_at_nodes(const mesh::Mesh& mesh, const tissue::StressField& field, int tet)
{
  if (!mesh.quadratic()) return field.stress.segment<6>(6 * tet).replicate<1, 4>();
  NodalStress stress(6, 10);
  stress.leftCols<4>() = field.corner.segment<24>(24 * tet).reshaped(6, 4);
  for (std::size_t k = 0; k < 6; ++k)
    stress.col(static_cast<Eigen::Index>(4 + k)) =
        0.5 * (stress.col(static_cast<Eigen::Index>(mesh::tet_edges[k][0])) +
               stress.col(static_cast<Eigen::Index>(mesh::tet_edges[k][1])));
  return stress;
}

VecX nodal_means(const mesh::Mesh& mesh, const tissue::StressField& field, int region)
{
  VecX sum = VecX::Zero(6 * mesh.node_count()), weight = VecX::Zero(mesh.node_count());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (region >= 0 && mesh.region[static_cast<std::size_t>(t)] != region) continue;
    const double volume = mesh::tet_volume(mesh, t);
    const NodalStress stress = stress_at_nodes(mesh, field, t);
    Eigen::Index a = 0;
    for (int node : mesh::nodes_of(mesh, t)) {
      sum.segment<6>(6 * node) += volume * stress.col(a++);
      weight[node] += volume;
    }
  }
  for (Eigen::Index i = 0; i < weight.size(); ++i)
    if (weight[i] > 0.0) sum.segment<6>(6 * i) /= weight[i];
  return sum;
}

std::vector<io::Field> stress_fields(const Simulation& simulation, const State& state)
{
  const StressOutput& wanted = simulation.scenario().output.stress;
  std::vector<io::Field> fields;
  if (!wanted.any()) return fields;
  const tissue::StressField found = simulation.tissue().stresses(state.tissue.u);
  if (!simulation.space().comm().root()) return fields;  // only rank 0 writes
  const Eigen::Index tets = found.energy.size();
  VecX mises(wanted.von_mises ? tets : 0), principal(wanted.principal_stress ? 3 * tets : 0);
  for (Eigen::Index t = 0; t < tets; ++t) {
    const Six s = found.stress.segment<6>(6 * t);
    if (wanted.von_mises) mises[t] = von_mises(s);
    if (wanted.principal_stress) principal.segment<3>(3 * t) = principal_values(s);
  }
  if (wanted.stress) fields.push_back(field("/stress", 6, "Pa", found.stress, false));
  if (wanted.von_mises) fields.push_back(field("/von_mises", 0, "Pa", mises, false));
  if (wanted.principal_stress)
    fields.push_back(field("/principal_stress", 3, "Pa", principal, false));
  if (wanted.strain_energy)
    fields.push_back(field("/strain_energy", 0, "J/m^3", found.energy, false));
  if (wanted.nodal_stress)
    fields.push_back(
        field("/nodal_stress", 6, "Pa", nodal_means(simulation.scenario().mesh, found), true));
  return fields;
}

}  // namespace trocar::driver
