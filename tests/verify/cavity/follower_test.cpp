#include <gtest/gtest.h>

#include "support/body.hpp"
#include "support/cavity.hpp"
#include "support/dense.hpp"

namespace trocar {
namespace {

using cavity::Model;
using core::MatX;
using core::Vec3;
using core::VecX;
using test::press;
using test::solved;

/// Everything dense and serial, written anew: K, the wall, and Newton's method on (u, p).
struct Dense
{
  explicit Dense(const step::Scene& scenario)
      : mesh(scenario.mesh),
        wall(mesh, "wall", false),
        K(test::dense_operator(mesh, scenario.tissue.materials[0], 1.0, 0.0)),
        u(VecX::Zero(K.rows()))
  {
    for (const auto& tool : scenario.tissue.boundary.displacements)
      for (int node : mesh::group_nodes(mesh, tool.group)) u.segment<3>(3 * node) = tool.value;
    for (int node = 0; node < mesh.node_count(); ++node) {
      const double z = mesh.x[std::size_t(node)].z();
      const bool held = z == 0.0 || z == height;
      for (int a = 0; a < 3; ++a)
        if (!held) free.push_back(3 * node + a);
    }
  }

  VecX wall_of(const VecX& field) const
  {
    VecX values(3 * Eigen::Index(wall.nodes().size()));
    for (std::size_t i = 0; i < wall.nodes().size(); ++i)
      values.segment<3>(3 * Eigen::Index(i)) = field.segment<3>(3 * wall.nodes()[i]);
    return values;
  }
  VecX nodal(const VecX& values) const
  {
    VecX field = VecX::Zero(K.rows());
    for (std::size_t i = 0; i < wall.nodes().size(); ++i)
      field.segment<3>(3 * wall.nodes()[i]) = values.segment<3>(3 * Eigen::Index(i));
    return field;
  }

  /// Newton for the follower model; the load p g(u) and the volume V(u) = V_0.
  void follow()
  {
    const auto n = Eigen::Index(free.size());
    for (int iteration = 0; iteration < 20; ++iteration) {
      const VecX x = wall.undeformed() + wall_of(u);
      const VecX g = nodal(law::volume_gradient(wall.surface(), x));
      MatX T = MatX::Zero(n + 1, n + 1);
      MatX H(K.rows(), K.cols());
      for (Eigen::Index j = 0; j < K.cols(); ++j)
        H.col(j) =
            nodal(law::volume_hessian_times(wall.surface(), x, wall_of(VecX::Unit(K.rows(), j))));
      T.topLeftCorner(n, n) = (K - p * H)(free, free);
      T.col(n).head(n) = -g(free);
      T.row(n).head(n) = -g(free).transpose();
      VecX r(n + 1);
      r.head(n) = (p * g - K * u)(free);
      r[n] = law::volume(wall.surface(), x) - wall.volume();
      const VecX d = test::solved(T, r);
      u(free) += d.head(n);
      p += d[n];
      if (d.head(n).norm() < 1e-15 * u.norm()) break;
    }
  }

  static constexpr double height = 0.05;
  const mesh::Mesh& mesh;
  cavity::Wall wall;
  MatX K;
  VecX u;
  double p = 0.0;
  std::vector<Eigen::Index> free;
};

// The whole program against a dense Newton method written for this test.
TEST(Follower, AgreesWithDenseNewton)
{
  step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
  press(scenario, 0.006);  // 12 %
  const base::Comm comm(MPI_COMM_WORLD);
  step::Model simulation(scenario, comm);
  const step::Outcome<step::Accepted> result = solved(simulation);
  Dense dense(scenario);
  dense.follow();
  const fem::GlobalField u = simulation.space.gather(result->state.tissue.u);
  EXPECT_LT((u.value - dense.u).norm(), 1e-9 * dense.u.norm());
  const cavity::CavityReport& report = result->report.cavities[0];
  EXPECT_NEAR(report.pressure, dense.p, 1e-9 * dense.p);
  EXPECT_LE(report.error, 1e-12);
  EXPECT_LE(result->report.linearisations, 5);  // Newton, cold
  // Reaction of the plate: K u less nothing, for the pressure does not act there.
  const VecX forces = dense.K * dense.u;
  Vec3 plate = Vec3::Zero();
  for (int node : mesh::group_nodes(scenario.mesh, "z1")) plate += forces.segment<3>(3 * node);
  EXPECT_LT((result->report.holders.tools[0] - plate).norm(), 1e-8 * plate.norm());
}

// Corotational tissue with a follower cavity: the same with a factor in every step and with old
// factors, in time and along a path.
TEST(Corotational, OldFactorsGiveTheSame)
{
  for (bool dynamic : {false, true}) {
    std::vector<double> pressure;
    for (double lag : {0.0, 1e-9}) {
      step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
      scenario.tissue.model = tissue::Model::corotational;
      scenario.tissue.lag_tolerance = lag;
      if (dynamic) scenario.time.is_static = false;
      scenario.time.step = 0.05;
      scenario.time.end = 0.2;
      press(scenario, 0.008);
      scenario.tissue.boundary.displacements[0].curve =
          core::parse_csv("time,factor\n0,0\n0.2,1\n", "test");
      const test::Run run = test::run(scenario);
      pressure.push_back(run.reports.back().cavities[0].pressure);
      EXPECT_LE(run.reports.back().cavities[0].error, 1e-12);
    }
    EXPECT_GT(pressure[0], 100.0);
    EXPECT_NEAR(pressure[1], pressure[0], 1e-6 * pressure[0]);
  }
}

// A body 3 m from the origin: nothing changes, because walls count from a point of their own.
TEST(FarFromTheOrigin, SamePressure)
{
  std::vector<double> pressure;
  for (double away : {0.0, 3.0}) {
    step::Scene scenario = test::cavity_scenario(5, 3, Model::follower);
    press(scenario, 0.005);
    for (Vec3& x : scenario.mesh.x) x += Vec3(away, -away, away);
    const step::StepReport report = solved(scenario);
    pressure.push_back(report.cavities[0].pressure);
    EXPECT_LE(report.cavities[0].error, 1e-12);
  }
  EXPECT_NEAR(pressure[1], pressure[0], 1e-9 * pressure[0]);
}

}  // namespace
}  // namespace trocar
