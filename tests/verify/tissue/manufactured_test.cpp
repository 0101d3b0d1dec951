#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/dense.hpp"
#include "fem/shape.hpp"
#include "support/body.hpp"

// Orders of convergence of every element in u (L2) and its gradient, up to nearly incompressible
// tissue, and the inf-sup number of those that are to stand it.
namespace trocar {
namespace {

using core::Mat3;
using core::Vec3;
using tissue::Dilatation;

/// u = v + w/λ with div v = 0: the pressure λ div u = div w stays what it is as λ grows.
///   v = curl (0, 0, ψ), ψ = a(x) a(y) b(z),   w = c b(x) b(y) b(z),
/// a = sin(2x + 0.3), b = sin(2x - 0.5); u is prescribed on the boundary.
struct Manufactured
{
  tissue::Material m;
  Vec3 c{1.0, -0.5, 0.7};

  struct Waves  ///< a and b by derivative
  {
    explicit Waves(double x)
        : a{std::sin(2 * x + 0.3), 2 * std::cos(2 * x + 0.3), -4 * std::sin(2 * x + 0.3),
            -8 * std::cos(2 * x + 0.3)},
          b{std::sin(2 * x - 0.5), 2 * std::cos(2 * x - 0.5), -4 * std::sin(2 * x - 0.5)}
    {
    }
    std::array<double, 4> a;
    std::array<double, 3> b;
  };

  Vec3 u(const Vec3& x) const
  {
    const Waves X(x.x()), Y(x.y()), Z(x.z());
    return Vec3(X.a[0] * Y.a[1] * Z.b[0], -X.a[1] * Y.a[0] * Z.b[0], 0.0) +
           c * (X.b[0] * Y.b[0] * Z.b[0] / m.lambda());
  }
  Mat3 gradient(const Vec3& x) const
  {
    const Waves X(x.x()), Y(x.y()), Z(x.z());
    Mat3 G;
    G << X.a[1] * Y.a[1] * Z.b[0], X.a[0] * Y.a[2] * Z.b[0], X.a[0] * Y.a[1] * Z.b[1],
        -X.a[2] * Y.a[0] * Z.b[0], -X.a[1] * Y.a[1] * Z.b[0], -X.a[1] * Y.a[0] * Z.b[1], 0, 0, 0;
    const Vec3 by(X.b[1] * Y.b[0] * Z.b[0], X.b[0] * Y.b[1] * Z.b[0], X.b[0] * Y.b[0] * Z.b[1]);
    return G + c * by.transpose() / m.lambda();
  }
  Vec3 body_force(const Vec3& x) const  ///< -μ Δu - (λ + μ) grad div u
  {
    const Waves X(x.x()), Y(x.y()), Z(x.z());
    const Vec3 of_v((X.a[2] * Y.a[1] + X.a[0] * Y.a[3]) * Z.b[0] + X.a[0] * Y.a[1] * Z.b[2],
                    -(X.a[3] * Y.a[0] + X.a[1] * Y.a[2]) * Z.b[0] - X.a[1] * Y.a[0] * Z.b[2], 0.0);
    Mat3 H;  // second derivatives of the product of sines
    const std::array<const Waves*, 3> wave{&X, &Y, &Z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        double product = 1.0;
        for (std::size_t k = 0; k < 3; ++k)
          product *= wave[k]->b[static_cast<std::size_t>((k == i) + (k == j))];
        H(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = product;
      }
    return -m.mu() * of_v - (m.mu() * H.trace() * c + (m.lambda() + m.mu()) * H * c) / m.lambda();
  }
};

/// Σ over five Gauss points in each collapsed coordinate: degree 7, not the program's rule.
template <class F>
void integrate(double volume, const F& f)
{
  const std::array<double, 5> x{0.04691007703066802, 0.23076534494715845, 0.5, 0.76923465505284155,
                                0.95308992296933198};
  const std::array<double, 5> w{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                0.23931433524968324, 0.11846344252809454};
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      for (std::size_t k = 0; k < 5; ++k) {
        const double a = x[i], b = x[j] * (1 - a), c = x[k] * (1 - a - b);
        f(Eigen::Vector4d(1 - a - b - c, a, b, c),
          6.0 * volume * w[i] * w[j] * w[k] * (1 - a) * (1 - a - b));
      }
}

/// A unit cube of n cells a side with its walls held, static and factored.
struct HeldCube : test::Body
{
  HeldCube(bool quadratic, Dilatation dilatation, const tissue::Material& material, int n)
      : test::Body(shape(quadratic, n), settings(dilatation, material))
  {
    tissue.prepare({0.0, 1.0, true});
  }
  static test::BlockShape shape(bool quadratic, int n)
  {
    test::BlockShape shape{n, n, n, Vec3::Ones(), 0.1};
    shape.quadratic = quadratic;
    return shape;
  }
  static tissue::TissueSettings settings(Dilatation dilatation, const tissue::Material& material)
  {
    tissue::TissueSettings settings;
    settings.model = tissue::Model::linear;
    settings.dilatation = dilatation;
    settings.materials = {material};
    for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
      settings.boundary.fixed.push_back({side, 7});
    return settings;
  }
};

struct Errors
{
  double L2 = 0.0, H1 = 0.0;
};

/// f(x, shape functions, barycentric coordinates, weight) at the points of one tet.
template <class F>
void over_tet(const mesh::Mesh& mesh, int t, const F& f)
{
  const auto corner = mesh::corners(mesh, t);
  integrate(mesh::tet_volume(mesh, t), [&](const Eigen::Vector4d& at, double weight) {
    const Vec3 x = at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2] + at[3] * corner[3];
    f(x, mesh::node_weights(mesh, at), at, weight);
  });
}

/// The solution of the discrete problem, on every rank.
fem::GlobalField solved(HeldCube& body, const Manufactured& exact)
{
  fem::OwnedField load = body.space.zero();
  for (std::size_t e = 0; e < body.space.tets(); ++e)
    over_tet(body.mesh, body.space.file_tet(e),
             [&](const Vec3& x, const mesh::NodeWeights& N, const Eigen::Vector4d&, double weight) {
               const Vec3 f = weight * exact.body_force(x);
               Eigen::Index a = 0;
               for (int node : body.space.nodes(e)) {
                 if (node < body.space.owned()) load.node(node) += N[a] * f;
                 ++a;
               }
             });
  fem::OwnedField given = test::nodal(body, [&](const Vec3& x) { return exact.u(x); });
  fem::OwnedField inside = given;
  body.tissue.fixed().clear(inside);
  given.value -= inside.value;
  tissue::LinearisationPoint at;
  body.tissue.configure(body.space.with_ghosts(given), at);
  load.value -= body.tissue.operate_by_elements(at, {}, given).value;
  return body.space.gather({given.value + body.tissue.factor().answer(load).value});
}

Errors manufactured_errors(bool quadratic, Dilatation dilatation, double poisson, int n)
{
  const Manufactured exact{{1.0, poisson, 1.0, 0.0, 0.0}};
  HeldCube body(quadratic, dilatation, exact.m, n);
  const fem::GlobalField u = solved(body, exact);
  Errors errors;
  const base::Comm& comm = body.space.comm();
  for (int t = comm.rank(); t < body.mesh.tet_count(); t += comm.size()) {
    const fem::TetShape linear = fem::tet_shape(mesh::corners(body.mesh, t));
    over_tet(
        body.mesh, t,
        [&](const Vec3& x, const mesh::NodeWeights& N, const Eigen::Vector4d& at, double weight) {
          Vec3 value = -exact.u(x);
          Mat3 gradient = -exact.gradient(x);
          Eigen::Index a = 0;
          for (int node : mesh::nodes_of(body.mesh, t)) {
            value += N[a] * u.node(node);
            const Vec3 by =
                body.mesh.quadratic()
                    ? Vec3(linear.gradient * mesh::quadratic_derivatives(at).row(a).transpose())
                    : Vec3(linear.gradient.col(a));
            gradient += u.node(node) * by.transpose();
            ++a;
          }
          errors.L2 += weight * value.squaredNorm();
          errors.H1 += weight * gradient.squaredNorm();
        });
  }
  return {std::sqrt(comm.sum(errors.L2)), std::sqrt(comm.sum(errors.H1))};
}

void expect_orders(const char* name, bool quadratic, Dilatation dilatation, double poisson,
                   std::array<int, 2> cells, double L2, double H1)
{
  const Errors coarse = manufactured_errors(quadratic, dilatation, poisson, cells[0]);
  const Errors fine = manufactured_errors(quadratic, dilatation, poisson, cells[1]);
  const double ratio = std::log(static_cast<double>(cells[1]) / cells[0]);
  const double by_L2 = std::log(coarse.L2 / fine.L2) / ratio;
  const double by_H1 = std::log(coarse.H1 / fine.H1) / ratio;
  std::printf("%-8s nu %.4f  %2d -> %2d cells  L2 %.3e order %.2f  H1 %.3e order %.2f\n", name,
              poisson, cells[0], cells[1], fine.L2, by_L2, fine.H1, by_H1);
  EXPECT_GE(by_L2, L2) << name << " at " << poisson;
  EXPECT_GE(by_H1, H1) << name << " at " << poisson;
}

TEST(ManufacturedSolution, ConvergesWithTheOrderOfTheElement)
{
  for (double poisson : {0.3, 0.45}) {
    expect_orders("p1", false, Dilatation::pointwise, poisson, {12, 24}, 1.9, 0.95);
    expect_orders("p1_anp", false, Dilatation::nodal, poisson, {10, 20}, 1.9, 0.95);
    expect_orders("p2", true, Dilatation::pointwise, poisson, {5, 9}, 2.85, 1.9);
    expect_orders("p2_anp", true, Dilatation::nodal, poisson, {5, 9}, 2.85, 1.9);
  }
}

TEST(ManufacturedSolution, DoesNotLockWhenNearlyIncompressible)
{
  expect_orders("p1_anp", false, Dilatation::nodal, 0.4999, {10, 20}, 1.9, 0.95);
  expect_orders("p2_anp", true, Dilatation::nodal, 0.4999, {5, 9}, 2.8, 1.9);
  expect_orders("p2_bbar", true, Dilatation::element, 0.4999, {5, 9}, 0, 0);
  expect_orders("p2", true, Dilatation::pointwise, 0.4999, {5, 9}, 0, 0);
  expect_orders("p1", false, Dilatation::pointwise, 0.4999, {10, 20}, 0, 0);
}

/// Smallest inf-sup number of displacement and corner pressures, |ε(u)| against the lumped norm of
/// p, over n cells a side; the constant pressure, which held walls cannot feel, left out.
double inf_sup(bool quadratic, int n)
{
  HeldCube body(quadratic, Dilatation::pointwise, {1.0, 0.0, 1.0, 0.0, 0.0}, n);  // σ = ε
  const int corners = (n + 1) * (n + 1) * (n + 1);                                // they come first
  core::MatX B = core::MatX::Zero(corners, 3 * body.mesh.node_count());
  core::VecX M = core::VecX::Zero(corners);
  for (int t = 0; t < body.mesh.tet_count(); ++t) {
    const fem::TetShape linear = fem::tet_shape(mesh::corners(body.mesh, t));
    integrate(linear.volume, [&](const Eigen::Vector4d& at, double weight) {
      for (int v = 0; v < 4; ++v) {
        const int row = body.mesh.tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(v)];
        M[row] += weight * at[v];
        Eigen::Index a = 0;
        for (int node : mesh::nodes_of(body.mesh, t)) {
          const Vec3 by =
              quadratic ? Vec3(linear.gradient * mesh::quadratic_derivatives(at).row(a).transpose())
                        : Vec3(linear.gradient.col(a));
          B.block<1, 3>(row, 3 * node) += weight * at[v] * by.transpose();
          ++a;
        }
      }
    });
  }
  core::MatX answers(3 * body.mesh.node_count(), corners);
  for (int v = 0; v < corners; ++v)
    answers.col(v) = body.space
                         .gather(body.tissue.factor().answer(
                             body.space.restrict_to_owned({core::VecX(B.row(v).transpose())})))
                         .value;
  const core::VecX scale = M.cwiseSqrt().cwiseInverse();
  const core::MatX S = scale.asDiagonal() * (B * answers) * scale.asDiagonal();
  const core::VecX values = core::symmetric_eigenvalues(core::MatX(0.5 * (S + S.transpose())));
  EXPECT_LT(std::abs(values[0]), 1e-10);
  return std::sqrt(std::max(0.0, values[1]));
}

// Over four levels: bounded below with quadratic tets; with linear ones it is 0, there are
// pressures that no displacement feels. What 2μ/3 of every point stabilises are displacements.
TEST(InfSup, IsBoundedBelowForQuadraticTets)
{
  std::vector<double> p1, p2;
  for (int n : {2, 3, 4, 6}) {
    p2.push_back(inf_sup(true, n));
    p1.push_back(inf_sup(false, n));
    std::printf("inf-sup, %d cells: p2_anp %.3f  p1_anp %.4f\n", n, p2.back(), p1.back());
  }
  EXPECT_GT(p2.back(), 0.9 * p2[1]);
  EXPECT_GT(p2.back(), 0.12);
  EXPECT_LT(p1.back(), 1e-6);
}

}  // namespace
}  // namespace trocar
