#include "mesh/quadratic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::mesh {

TetNodes nodes_of(const Mesh& mesh, int tet)
{
  const auto t = static_cast<std::size_t>(tet);
  TetNodes nodes{{}, mesh.nodes_per_tet()};
  std::copy(mesh.tets[t].begin(), mesh.tets[t].end(), nodes.node.begin());
  if (mesh.quadratic())
    std::copy(mesh.middles[t].begin(), mesh.middles[t].end(), nodes.node.begin() + 4);
  return nodes;
}

std::vector<int> nodes_of(const Mesh& mesh, const Face& face)
{
  std::vector<int> nodes(face.begin(), face.end());
  if (mesh.quadratic())
    for (std::size_t k = 0; k < 3; ++k) nodes.push_back(mesh.middle_of(face[k], face[(k + 1) % 3]));
  return nodes;
}

void make_quadratic(Mesh& mesh)
{
  if (mesh.quadratic()) return;
  std::vector<std::array<int, 2>> edges;
  for (const Tet& tet : mesh.tets)
    for (const auto& [a, b] : tet_edges)
      edges.push_back({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const int corners = mesh.node_count();
  const long long last = *std::max_element(mesh.node_tag.begin(), mesh.node_tag.end());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    mesh.x.push_back(0.5 * (mesh.x[static_cast<std::size_t>(edges[e][0])] +
                            mesh.x[static_cast<std::size_t>(edges[e][1])]));
    mesh.node_tag.push_back(last + 1 + static_cast<long long>(e));
  }
  for (const Tet& tet : mesh.tets) {
    Middles middles;
    for (std::size_t k = 0; k < 6; ++k) {
      const int a = tet[tet_edges[k][0]], b = tet[tet_edges[k][1]];
      const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
      const auto at = std::lower_bound(edges.begin(), edges.end(), edge);
      middles[k] = corners + static_cast<int>(at - edges.begin());
    }
    mesh.middles.push_back(middles);
  }
  mesh.index_middles();
}

std::optional<std::array<int, 2>> ends_of_middle(const Mesh& mesh, int node)
{
  for (std::size_t t = 0; t < mesh.middles.size(); ++t)
    for (std::size_t k = 0; k < 6; ++k)
      if (mesh.middles[t][k] == node)
        return std::array<int, 2>{mesh.tets[t][tet_edges[k][0]], mesh.tets[t][tet_edges[k][1]]};
  return std::nullopt;
}

void make_linear(Mesh& mesh)
{
  if (!mesh.quadratic()) return;
  std::vector<int> number(mesh.x.size(), -1);
  for (const Tet& tet : mesh.tets)
    for (int node : tet) number[static_cast<std::size_t>(node)] = 0;
  int kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    mesh.x[static_cast<std::size_t>(kept)] = mesh.x[i];
    mesh.node_tag[static_cast<std::size_t>(kept)] = mesh.node_tag[i];
    number[i] = kept++;
  }
  mesh.x.resize(static_cast<std::size_t>(kept));
  mesh.node_tag.resize(static_cast<std::size_t>(kept));
  const auto renumber = [&](auto& nodes) {
    for (int& node : nodes) node = number[static_cast<std::size_t>(node)];
  };
  for (Tet& tet : mesh.tets) renumber(tet);
  for (SurfaceGroup& surface : mesh.surfaces)
    for (Face& face : surface.faces) renumber(face);
  for (PointGroup& points : mesh.points) {
    renumber(points.nodes);
    std::erase(points.nodes, -1);
    for (auto& edge : points.edges) renumber(edge);
  }
  mesh.middles.clear();
  mesh.index_middles();
}

Eigen::Matrix<double, 10, 1> quadratic_shape(const Eigen::Vector4d& at)
{
  Eigen::Matrix<double, 10, 1> N;
  for (int a = 0; a < 4; ++a) N[a] = at[a] * (2.0 * at[a] - 1.0);
  for (std::size_t k = 0; k < 6; ++k)
    N[static_cast<Eigen::Index>(4 + k)] = 4.0 * at[static_cast<Eigen::Index>(tet_edges[k][0])] *
                                          at[static_cast<Eigen::Index>(tet_edges[k][1])];
  return N;
}

Eigen::Matrix<double, 10, 4> quadratic_derivatives(const Eigen::Vector4d& at)
{
  Eigen::Matrix<double, 10, 4> D = Eigen::Matrix<double, 10, 4>::Zero();
  for (int a = 0; a < 4; ++a) D(a, a) = 4.0 * at[a] - 1.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto a = static_cast<Eigen::Index>(tet_edges[k][0]);
    const auto b = static_cast<Eigen::Index>(tet_edges[k][1]);
    D(static_cast<Eigen::Index>(4 + k), a) = 4.0 * at[b];
    D(static_cast<Eigen::Index>(4 + k), b) = 4.0 * at[a];
  }
  return D;
}

NodeWeights node_weights(const Mesh& mesh, const Eigen::Vector4d& at)
{
  if (mesh.quadratic()) return quadratic_shape(at);
  return at;
}

TetPositions positions(const Mesh& mesh, int tet)
{
  const TetNodes nodes = nodes_of(mesh, tet);
  TetPositions x(3, nodes.count);
  Eigen::Index a = 0;
  for (int node : nodes) x.col(a++) = mesh.x[static_cast<std::size_t>(node)];
  return x;
}

bool is_straight(const TetPositions& x)
{
  if (x.cols() == 4) return true;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 a = x.col(static_cast<Eigen::Index>(tet_edges[k][0]));
    const Vec3 b = x.col(static_cast<Eigen::Index>(tet_edges[k][1]));
    const Vec3 off = x.col(static_cast<Eigen::Index>(4 + k)) - 0.5 * (a + b);
    if (off.squaredNorm() > 1e-24 * (b - a).squaredNorm()) return false;
  }
  return true;
}

namespace {

std::array<Vec3, 4> corners_of(const TetPositions& x)
{
  return {x.col(0), x.col(1), x.col(2), x.col(3)};
}

/// Jacobian of the map by barycentric coordinates 1, 2, 3; coordinate 0 is 1 minus their sum.
core::Mat3 jacobian(const TetPositions& x, const Eigen::Vector4d& at)
{
  const Eigen::Matrix<double, 3, 4> by = x * quadratic_derivatives(at);
  return by.rightCols<3>().colwise() - by.col(0);
}

}  // namespace

Eigen::Vector4d local_coordinates(const TetPositions& x, const Vec3& p)
{
  const Eigen::Vector4d straight = barycentric(corners_of(x), p);
  if (is_straight(x)) return straight;
  constexpr int most = 20;
  constexpr double far = 4.0, enough = 1e-14;
  Eigen::Vector4d at = straight;
  for (int k = 0; k < most; ++k) {
    const Vec3 rest = p - x * quadratic_shape(at);
    const Vec3 d = jacobian(x, at).partialPivLu().solve(rest);
    at += Eigen::Vector4d(-d.sum(), d[0], d[1], d[2]);
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > far) break;
    if (d.cwiseAbs().maxCoeff() < enough * (1.0 + at.cwiseAbs().maxCoeff()) || k + 1 == most)
      return at;
  }
  return straight;
}

double curved_volume(const TetPositions& x)
{
  const auto p = corners_of(x);
  if (is_straight(x)) return tet_volume(p[0], p[1], p[2], p[3]);
  // Quadrature of degree 3 (Zienkiewicz and Taylor 2000, table 9.2): centroid and four points.
  constexpr double middle = -4.0 / 5.0, around = 9.0 / 20.0;
  double mean = middle * jacobian(x, Eigen::Vector4d::Constant(0.25)).determinant();
  for (int a = 0; a < 4; ++a) {
    Eigen::Vector4d at = Eigen::Vector4d::Constant(1.0 / 6.0);
    at[a] = 0.5;
    mean += around * jacobian(x, at).determinant();
  }
  return mean / 6.0;
}

double smallest_jacobian(const TetPositions& x)
{
  if (is_straight(x)) return 1.0;
  const auto p = corners_of(x);
  const double straight = 6.0 * tet_volume(p[0], p[1], p[2], p[3]);
  double smallest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 4; ++a)
    for (double own : {1.0, (5.0 + 3.0 * std::sqrt(5.0)) / 20.0}) {
      Eigen::Vector4d at = Eigen::Vector4d::Constant((1.0 - own) / 3.0);
      at[a] = own;
      smallest = std::min(smallest, jacobian(x, at).determinant() / straight);
    }
  return smallest;
}

}  // namespace trocar::mesh
