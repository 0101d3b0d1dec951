#include "support/body.hpp"

#include "fem/shape.hpp"

namespace trocar::test {

core::MatX dense_operator(const mesh::Mesh& mesh, const tissue::Material& m, double scale_k,
                          double scale_m)
{
  Eigen::Matrix<double, 6, 6> D = Eigen::Matrix<double, 6, 6>::Zero();
  D.topLeftCorner<3, 3>().setConstant(m.lambda());
  D.diagonal().head<3>().array() += 2.0 * m.mu();
  D.diagonal().tail<3>().setConstant(m.mu());
  core::MatX A = core::MatX::Zero(3 * mesh.node_count(), 3 * mesh.node_count());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto shape = fem::tet_shape(mesh::corners(mesh, t));
    Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
    for (int a = 0; a < 4; ++a) {
      const core::Vec3 g = shape.gradient.col(a);
      for (int k = 0; k < 3; ++k) B(k, 3 * a + k) = g[k];
      B.block<3, 3>(3, 3 * a) << g.y(), g.x(), 0, 0, g.z(), g.y(), g.z(), 0, g.x();
    }
    const Eigen::Matrix<double, 12, 12> K = scale_k * shape.volume * B.transpose() * D * B;
    const auto& tet = mesh.tets[static_cast<std::size_t>(t)];
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const double mass = scale_m * m.density * shape.volume * (a == b ? 0.1 : 0.05);
        A.block<3, 3>(3 * tet[static_cast<std::size_t>(a)], 3 * tet[static_cast<std::size_t>(b)]) +=
            K.block<3, 3>(3 * a, 3 * b) + mass * core::Mat3::Identity();
      }
  }
  return A;
}

void fix_dense(core::MatX& A, const fem::Dirichlet& fixed, int nodes)
{
  for (int node = 0; node < nodes; ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (!fixed.fixed(node, axis)) continue;
      const int dof = 3 * node + axis;
      A.row(dof).setZero();
      A.col(dof).setZero();
      A(dof, dof) = 1.0;
    }
}

}  // namespace trocar::test
