#include "support/cones.hpp"

#include <cmath>
#include <random>

namespace trocar::test {
namespace {

MatX random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  MatX A(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j) A(i, j) = normal(random);
  return A;
}

MatX compliance(Cones kind, const std::vector<core::Vec3>& at, std::mt19937& random)
{
  const auto rows = static_cast<Eigen::Index>(3 * at.size());
  if (kind == Cones::half_rank) {
    const MatX A = random_matrix(rows, rows / 2, random);
    return 1e-3 / static_cast<double>(rows / 2) * (A * A.transpose());
  }
  MatX W = MatX::Zero(rows, rows);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < at.size(); ++j) {
      const core::Vec3 apart = at[i] - at[j];
      const double far = std::sqrt(apart.squaredNorm() + 1.0);
      const core::Mat3 block =
          core::Mat3::Identity() + 0.3 * apart * apart.transpose() / (far * far);
      W.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          (i == j ? 1.5e-3 : 1e-3) / far * block;
    }
  if (kind == Cones::half_space) return W;
  MatX H(rows, 6);  // motions of a rigid body
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(3 * i) + axis;
      H.row(row) << core::Vec3::Unit(axis).transpose(),
          (0.2 * at[i]).cross(core::Vec3::Unit(axis)).transpose();
    }
  return 1e-3 * H * H.transpose() + (kind == Cones::stiff ? 1e-3 : 0.0) * W;
}

}  // namespace

KnownCones known_cones(Cones kind, int groups, double friction, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto rows = static_cast<Eigen::Index>(3 * groups);
  KnownCones made{{}, VecX::Zero(rows), VecX::Zero(rows)};
  std::vector<core::Vec3> at;
  for (int k = 0; k < groups; ++k) at.push_back(10.0 * core::Vec3(part(random), part(random), 0.0));
  made.problem.W = compliance(kind, at, random);
  for (int k = 0; k < groups; ++k) {
    const double what = part(random), angle = 2.0 * M_PI * part(random);
    const Eigen::Vector2d e(std::cos(angle), std::sin(angle));
    auto lambda = made.lambda.segment<3>(3 * k);
    auto delta = made.delta.segment<3>(3 * k);
    if (what < 0.3) {
      delta << 1e-3 * (0.1 + part(random)), 1e-3 * e;
    } else {
      lambda[0] = 0.1 + part(random);
      const bool slips = what < 0.65;
      lambda.tail<2>() = (slips ? 1.0 : 0.8 * part(random)) * friction * lambda[0] * e;
      if (slips) delta.tail<2>() = -1e-3 * (0.1 + part(random)) * e;
    }
    made.problem.blocks.push_back({3 * k, law::Law::cone(friction), k});
  }
  made.problem.g = made.delta - made.problem.W * made.lambda;
  made.problem.start = VecX::Zero(rows);
  return made;
}

}  // namespace trocar::test
