#include "post/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/quadratic.hpp"
#include "support/block.hpp"

namespace trocar::post {
namespace {

using core::Mat3;

constexpr double E = 4000.0, nu = 0.3;
constexpr double mu = E / (2.0 * (1.0 + nu)), K = E / (3.0 * (1.0 - 2.0 * nu));
const std::vector<tissue::Material> soft{{E, nu, 1000.0, 0.0, 0.0}};

mesh::Mesh bar(bool quadratic)
{
  test::BlockShape shape{3, 2, 2, Vec3(0.03, 0.02, 0.02), 0.2};
  shape.quadratic = quadratic;
  return test::block(shape);
}

double number(int k)
{
  return std::sin(1.0 + k);
}

/// A stress that is S times another number in every tet, or at every corner of a quadratic one.
tissue::StressField numbers_times(const Mat3& S, const mesh::Mesh& mesh)
{
  Eigen::Matrix<double, 6, 1> six;
  six << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(0, 2);
  const int tets = mesh.tet_count();
  tissue::StressField field{VecX::Zero(6 * tets), VecX::Zero(mesh.quadratic() ? 24 * tets : 0),
                            VecX::Zero(tets)};
  for (int t = 0; t < tets; ++t) {
    field.stress.segment<6>(6 * t) = number(t) * six;
    for (int a = 0; mesh.quadratic() && a < 4; ++a)
      field.corner.segment<6>(24 * t + 6 * a) = number(4 * t + a) * six;
  }
  return field;
}

VecX errors_of(const Mat3& S, const mesh::Mesh& mesh)
{
  return recovery_errors(mesh, soft, numbers_times(S, mesh));
}

Mat3 sheared(double tau)
{
  Mat3 S = Mat3::Zero();
  S(0, 1) = S(1, 0) = tau;
  return S;
}

// What a stress stores does not depend on the axes it is written in: shear is a pull along one
// diagonal and a push along the other.
TEST(ErrorEstimate, IsTheSameInTurnedAxes)
{
  Mat3 any;
  any << 3.0, 1.0, -2.0, 1.0, -4.0, 0.5, -2.0, 0.5, 2.0;
  for (bool quadratic : {false, true}) {
    const mesh::Mesh mesh = bar(quadratic);
    const VecX diagonal = errors_of(Vec3(70.0, -70.0, 0.0).asDiagonal(), mesh);
    EXPECT_GT(diagonal.minCoeff(), 0.0);
    EXPECT_LT((errors_of(sheared(70.0), mesh) - diagonal).norm(), 1e-12 * diagonal.norm());
    const VecX upright = errors_of(any, mesh);
    for (int turn = 1; turn < 4; ++turn) {
      const Mat3 Q = core::rotation_exp(turn * Vec3(0.4, -0.9, 0.3));
      EXPECT_LT((errors_of(Q * any * Q.transpose(), mesh) - upright).norm(),
                1e-12 * upright.norm());
    }
  }
}

/// ∫ d² over every tet, d linear between what the means of the tets' numbers at the nodes are off.
VecX squares_of_numbers(const mesh::Mesh& mesh)
{
  VecX mean = VecX::Zero(mesh.node_count()), weight = mean, squares(mesh.tet_count());
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : mesh.tets[static_cast<std::size_t>(t)]) {
      mean[node] += mesh::tet_volume(mesh, t) * number(t);
      weight[node] += mesh::tet_volume(mesh, t);
    }
  for (int t = 0; t < mesh.tet_count(); ++t) {
    double sum = 0.0, of_squares = 0.0;
    for (int node : mesh.tets[static_cast<std::size_t>(t)]) {
      const double d = mean[node] / weight[node] - number(t);
      sum += d;
      of_squares += d * d;
    }
    squares[t] = mesh::tet_volume(mesh, t) / 20.0 * (of_squares + sum * sum);
  }
  return squares;
}

// σ²/E pulled along an axis, τ²/μ in shear, p²/K under pressure from all sides.
TEST(ErrorEstimate, CountsStressesByWhatTheyStore)
{
  for (bool quadratic : {false, true}) {
    const mesh::Mesh mesh = bar(quadratic);
    const VecX pulled = errors_of(Vec3(0.0, 50.0, 0.0).asDiagonal(), mesh) / (50.0 * 50.0 / E);
    const VecX shear = errors_of(sheared(50.0), mesh) / (50.0 * 50.0 / mu);
    const VecX pressed = errors_of(-50.0 * Mat3::Identity(), mesh) / (50.0 * 50.0 / K);
    EXPECT_LT((shear - pulled).norm(), 1e-12 * pulled.norm());
    EXPECT_LT((pressed - pulled).norm(), 1e-12 * pulled.norm());
    if (!quadratic) {
      EXPECT_LT((pulled - squares_of_numbers(mesh)).norm(), 1e-12 * pulled.norm());
    }
  }
}

// Where two volumes meet stress may jump: each is constant, and nothing is off.
TEST(ErrorEstimate, TakesEveryVolumeByItself)
{
  mesh::Mesh mesh = bar(false);
  mesh.volumes = {"front", "back"};
  tissue::StressField field = numbers_times(sheared(1.0), mesh);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const bool back = t >= mesh.tet_count() / 2;
    mesh.region[static_cast<std::size_t>(t)] = back ? 1 : 0;
    field.stress.segment<6>(6 * t).setConstant(back ? 500.0 : 20.0);
  }
  EXPECT_LT(recovery_errors(mesh, {soft[0], soft[0]}, field).maxCoeff(), 1e-20);
}

/// Two cubes of edge 1 apart from each other, in six equal tets each.
mesh::Mesh two_cubes(bool quadratic)
{
  test::BlockShape shape{3, 1, 1, Vec3(3.0, 1.0, 1.0), 0.0};
  shape.hole = [](const Vec3& x) { return x.x() > 1.0 && x.x() < 2.0; };
  shape.quadratic = quadratic;
  return test::block(shape);
}

/// Sizes at the nodes over the tets' mean edge, as edges of the mesh that Gmsh makes of them, in
/// either cube; `coarser` is the error of the first one's tets over that of the second one's.
Eigen::Vector2d edges_wanted(const mesh::Mesh& mesh, double coarser, double allowed)
{
  VecX errors = VecX::Ones(mesh.tet_count());
  errors.head<6>().setConstant(coarser);
  const double target = 0.1;
  const VecX sizes = wanted_sizes(mesh, errors, allowed / (target * target), target);
  Eigen::Vector2d wanted;
  for (int cube : {0, 1})
    for (int t = 6 * cube; t < 6 * cube + 6; ++t) {
      const double now = mesh::mean_edge(mesh::corners(mesh, t));
      for (int node : mesh::nodes_of(mesh, t)) {
        const double edge = 1.2 * sizes[node] / now;
        if (t > 6 * cube) {
          EXPECT_NEAR(edge, wanted[cube], 1e-12 * edge);
        }
        wanted[cube] = edge;
      }
    }
  return wanted;
}

// Equal parts of a mesh: the error e² h^(2p) must come down to what is allowed, with elements
// coarser by e^(-2/(2p+3)) where the error is less.
TEST(WantedSizes, LeadToTheTargetWithTheFewestTets)
{
  for (bool quadratic : {false, true}) {
    const mesh::Mesh mesh = two_cubes(quadratic);
    const double p = quadratic ? 2.0 : 1.0;
    const double factor = std::pow(0.6, 2.0 * p);
    const Eigen::Vector2d same = edges_wanted(mesh, 1.0, 12.0 * factor);
    EXPECT_NEAR(same[0], 0.6, 1e-12);
    EXPECT_NEAR(same[1], 0.6, 1e-12);
    // Edges of 1.2 and 0.8 times: (2/3)^(2p+3) of the error.
    const double less = std::pow(2.0 / 3.0, 2.0 * p + 3.0);
    const double left = 6.0 * (less * std::pow(1.2, 2.0 * p) + std::pow(0.8, 2.0 * p));
    const Eigen::Vector2d unlike = edges_wanted(mesh, less, left);
    EXPECT_NEAR(unlike[0], 1.2, 1e-12);
    EXPECT_NEAR(unlike[1], 0.8, 1e-12);
  }
}

// Whatever is asked for, no tet becomes more than twice as large or a quarter as small at once;
// then all are scaled to the target. So it depends on how far the mesh is from the target, by the
// exponent 1/(2p), how large one part is beside the other.
TEST(WantedSizes, ChangeByNoMoreThanAQuarterAndTwice)
{
  for (bool quadratic : {false, true}) {
    const mesh::Mesh mesh = two_cubes(quadratic);
    const double p = quadratic ? 2.0 : 1.0;
    const double little = std::pow(0.1, 2.0 * p + 3.0);
    // Σ e^(2d/(2p+d)) = 6 (1 + 1/1000), so that half the edge is asked for where e is 1, and five
    // times it where e is little: twice is what that gets.
    const double allowed = 6.006 * std::pow(0.5, 2.0 * p);
    const double led_to = 6.0 * (std::pow(0.5, 2.0 * p) + little * std::pow(2.0, 2.0 * p));
    const double scale = std::pow(allowed / led_to, 0.5 / p);
    const Eigen::Vector2d wanted = edges_wanted(mesh, little, allowed);
    EXPECT_NEAR(wanted[0], 2.0 * scale, 1e-12);
    EXPECT_NEAR(wanted[1], 0.5 * scale, 1e-12);
    // A tenth of the edge is asked for where e is 1: a quarter, and the edge as it is elsewhere.
    const Eigen::Vector2d finer = edges_wanted(mesh, little, 6.006 * std::pow(0.1, 2.0 * p));
    EXPECT_NEAR(finer[0] / finer[1], 4.0, 1e-12);
  }
}

}  // namespace
}  // namespace trocar::post
