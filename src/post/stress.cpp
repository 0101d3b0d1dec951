#include "post/stress.hpp"

#include <cmath>

#include "core/dense.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::post {

double von_mises(const Voigt& s)
{
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * s.tail<3>().squaredNorm());
}

Vec3 principal_values(const Voigt& s)
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

}  // namespace trocar::post
