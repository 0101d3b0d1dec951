#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "post/error_estimate.hpp"
#include "support/body.hpp"
#include "support/cavity.hpp"
#include "support/shell.hpp"

namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;
using Six = Eigen::Matrix<double, 6, 1>;

using test::nodal;

// A stretch along x: Hooke's stress of linear tissue; of corotational tissue the Cauchy stress of
// the stretch, turned with the body by any rotation.
TEST(Stress, OfAStretchAndARotation)
{
  const double E = 4000.0, nu = 0.3, stretch = 0.1;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  const Mat3 U = Vec3(1.0 + stretch, 1.0, 1.0).asDiagonal();
  const Mat3 turn = Eigen::AngleAxisd(1.2, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (tissue::Model model : {tissue::Model::linear, tissue::Model::corotational}) {
    tissue::TissueSettings settings;
    settings.model = model;
    settings.materials = {{E, nu, 1000.0, 0.0, 0.3}};
    test::Body body({3, 2, 2, Vec3(1.0, 0.7, 0.8), 0.2}, settings);
    const bool turned = model == tissue::Model::corotational;
    const Mat3 R = turned ? turn : Mat3(Mat3::Identity());
    const auto u = nodal(body, [&](const Vec3& X) { return Vec3(R * U * X - X); });
    const tissue::StressField field = body.tissue.stresses(u);
    Mat3 s = Mat3::Zero();
    s.diagonal() << (lambda + 2 * mu) * stretch, lambda * stretch, lambda * stretch;
    // T U / det U, with T the stress above; U differs from 1 along x alone.
    if (turned) s.diagonal() = Vec3(s(0, 0), s(1, 1) / 1.1, s(2, 2) / 1.1);
    s = R * s * R.transpose();
    Six expected;
    expected << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
    for (int t = 0; t < body.mesh.tet_count(); ++t) {
      EXPECT_LT((field.stress.segment<6>(6 * t) - expected).norm(), 1e-11 * expected.norm());
      EXPECT_NEAR(field.energy[t], 0.5 * (lambda + 2 * mu) * stretch * stretch, 1e-10 * E);
    }
    const core::VecX means = post::nodal_means(body.mesh, field);
    EXPECT_LT((means.head<6>() - expected).norm(), 1e-11 * expected.norm());
    EXPECT_EQ(body.ledger.stress_evaluations, 1);
    EXPECT_LT(post::recovery_errors(body.mesh, settings.materials, field).sum(),
              1e-20 * field.energy.sum());  // nothing to be estimated
  }
}

TEST(Stress, MisesAndPrincipalValues)
{
  Six s;
  s << 0, 0, 0, 50.0, 0, 0;  // pure shear
  EXPECT_NEAR(post::von_mises(s), 50.0 * std::sqrt(3.0), 1e-12);
  EXPECT_LT((post::principal_values(s) - Vec3(50, 0, -50)).norm(), 1e-12);
  s << 7, 7, 7, 0, 0, 0;
  EXPECT_NEAR(post::von_mises(s), 0.0, 1e-12);
  s << 3, -1, 2, 0.5, -0.7, 1.1;  // invariants
  const Vec3 p = post::principal_values(s);
  EXPECT_NEAR(p.sum(), 4.0, 1e-12);
  EXPECT_NEAR(post::von_mises(s),
              std::sqrt(0.5 * (std::pow(p[0] - p[1], 2) + std::pow(p[1] - p[2], 2) +
                               std::pow(p[2] - p[0], 2))),
              1e-12);
}

/// The sizes, 1.2 of them being edges of Gmsh's tets, predict the target by h: Σ e² (h_new/h)².
void expect_sizes_lead_to_target(const mesh::Mesh& mesh, const core::VecX& errors)
{
  const double energy = 4.0 * errors.sum(), target = 0.3;  // 50 % now
  const core::VecX sizes = post::wanted_sizes(mesh, errors, energy, target);
  double predicted = 0.0, ends = 0.0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    double size = 0.0;
    for (int node : mesh.tets[static_cast<std::size_t>(t)]) size += 0.25 * sizes[node];
    const double ratio = 1.2 * size / mesh::mean_edge(mesh::corners(mesh, t));
    predicted += errors[t] * ratio * ratio;
    ends = std::max(ends, ratio);
  }
  EXPECT_NEAR(std::sqrt(predicted / energy), target, 1e-12);
  EXPECT_LT(ends, 2.0);
}

// Lamé's shell under inner pressure: the stress of the tets converges with order 1, the means at
// inner nodes with a higher one.
TEST(Stress, LameShellConverges)
{
  const double a = 0.011, b = 0.025, p = 100.0, E = 15000.0, nu = 0.3;
  const double k = p * a * a * a / (b * b * b - a * a * a);
  const auto exact = [&](const Vec3& x) {
    const double r = x.norm(), c = std::pow(b / r, 3);
    const Vec3 n = x / r;
    const Mat3 s = k * (1.0 - c) * n * n.transpose() +
                   k * (1.0 + 0.5 * c) * (Mat3::Identity() - n * n.transpose());
    Six six;
    six << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
    return six;
  };
  std::vector<double> of_tets, of_nodes, effectivity;
  for (int levels : {1, 2, 3}) {
    step::Scene scenario = test::fluid_filled(test::shell(levels, 3 << (levels - 1), a, b),
                                              {E, nu, 1000.0, 0.0, 0.0}, cavity::Model::linear);
    scenario.tissue.boundary.fixed = {{"on_x", 6}, {"on_y", 5}, {"on_z", 3}};
    cavity::CavitySettings& fluid = scenario.cavities.cavities[0];
    fluid.fluid.kind = law::FluidLaw::Kind::pressure;
    fluid.pressure.mean = p;
    step::Model simulation(scenario, base::Comm(MPI_COMM_WORLD));
    const step::Outcome<step::Accepted> result = step::initial_state(simulation);
    ASSERT_TRUE(result) << result.why();
    const tissue::StressField field = simulation.tissue.stresses(result->state.tissue.u);
    double off = 0.0, all = 0.0, true_error = 0.0;
    for (int t = 0; t < scenario.mesh.tet_count(); ++t) {
      Vec3 middle = Vec3::Zero();
      for (const Vec3& x : mesh::corners(scenario.mesh, t)) middle += 0.25 * x;
      const double volume = mesh::tet_volume(scenario.mesh, t);
      off += volume * (field.stress.segment<6>(6 * t) - exact(middle)).squaredNorm();
      all += volume * exact(middle).squaredNorm();
      // Energy error at four points of the tet (degree 2).
      for (int q = 0; q < 4; ++q) {
        Vec3 x = Vec3::Zero();
        const auto corner = mesh::corners(scenario.mesh, t);
        for (int a = 0; a < 4; ++a)
          x += (a == q ? 0.5854101966249685 : 0.1381966011250105) *
               corner[static_cast<std::size_t>(a)];
        const Six d = field.stress.segment<6>(6 * t) - exact(x);
        const double trace = d.head<3>().sum();
        true_error += 0.25 * volume / E *
                      ((1 + nu) * (d.head<3>().squaredNorm() + 2 * d.tail<3>().squaredNorm()) -
                       nu * trace * trace);
      }
    }
    const core::VecX estimate =
        post::recovery_errors(scenario.mesh, scenario.tissue.materials, field);
    effectivity.push_back(std::sqrt(estimate.sum() / true_error));
    expect_sizes_lead_to_target(scenario.mesh, estimate);
    of_tets.push_back(std::sqrt(off / all));
    const core::VecX means = post::nodal_means(scenario.mesh, field);
    off = all = 0.0;
    for (int i = 0; i < scenario.mesh.node_count(); ++i) {
      const Vec3& x = scenario.mesh.x[static_cast<std::size_t>(i)];
      if (x.norm() < 1.2 * a || x.norm() > b / 1.1) continue;
      off += (means.segment<6>(6 * i) - exact(x)).squaredNorm();
      all += exact(x).squaredNorm();
    }
    of_nodes.push_back(std::sqrt(off / all));
  }
  std::printf("[ stress ] tets %.3g %.3g %.3g, nodes %.3g %.3g %.3g\n", of_tets[0], of_tets[1],
              of_tets[2], of_nodes[0], of_nodes[1], of_nodes[2]);
  std::printf("[ error estimate ] over the true one %.3f %.3f %.3f\n", effectivity[0],
              effectivity[1], effectivity[2]);
  EXPECT_NEAR(effectivity[2], 1.0, 0.15);
  EXPECT_LT(std::abs(effectivity[2] - 1.0), std::abs(effectivity[1] - 1.0));
  EXPECT_GT(std::log2(of_tets[1] / of_tets[2]), 0.85);
  EXPECT_GT(std::log2(of_nodes[1] / of_nodes[2]), 1.3);
}

}  // namespace
}  // namespace trocar
