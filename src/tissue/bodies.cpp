#include "tissue/bodies.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "core/dense.hpp"
#include "core/failure.hpp"
#include "mesh/topology.hpp"

namespace trocar::tissue {
namespace {

using core::Vec3;
using Motions = Eigen::Matrix<double, 6, 6>;

/// Sums over the nodes of a body.
struct Moments
{
  double count = 0.0;
  Vec3 first = Vec3::Zero();
  core::Mat3 second = core::Mat3::Zero();

  Vec3 middle() const { return first / count; }
  /// Sides of the box with the same moments, ascending; they do not depend on how the body lies.
  Vec3 sides() const
  {
    const core::Mat3 spread = second / count - middle() * middle().transpose();
    return (12.0 * core::symmetric_eigenvalues(spread)).cwiseMax(0.0).cwiseSqrt();
  }
};

/// Whether fixed dofs leave a body no rigid motion: whether Σ m mᵀ over them has rank 6, where m
/// holds the displacement of a dof in each of six rigid motions.
bool full(const Motions& sum)
{
  const core::VecX seen = core::symmetric_eigenvalues(core::MatX(sum));
  return seen[0] > 1e-10 * seen[5];
}

}  // namespace

Bodies bodies_of(const mesh::Mesh& mesh, const fem::Dirichlet& fixed)
{
  int count = 0;
  Bodies bodies{{}, mesh::connected_components(mesh, count)};
  const auto parts = static_cast<std::size_t>(count);
  std::vector<Moments> moments(parts);
  std::vector<std::set<int>> volumes(parts);
  const auto body_of = [&](int node) {
    return static_cast<std::size_t>(bodies.of_node[static_cast<std::size_t>(node)]);
  };
  for (int node = 0; node < mesh.node_count(); ++node) {
    Moments& mine = moments[body_of(node)];
    const Vec3 x = mesh.x[static_cast<std::size_t>(node)] - mesh.x[0];
    mine.count += 1.0;
    mine.first += x;
    mine.second += x * x.transpose();
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    volumes[body_of(mesh.tets[t][0])].insert(mesh.region[t]);
  std::vector<Vec3> sides;
  for (const Moments& one : moments) sides.push_back(one.sides());
  std::vector<Motions> held(parts, Motions::Zero());
  for (int node = 0; node < mesh.node_count(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (!fixed.fixed(node, axis)) continue;
      const Vec3 from = mesh.x[static_cast<std::size_t>(node)] - mesh.x[0];
      const Vec3 arm =
          (from - moments[body_of(node)].middle()) / std::max(sides[body_of(node)].norm(), 1e-300);
      Eigen::Matrix<double, 6, 1> motion;
      motion << Vec3::Unit(axis), arm.cross(Vec3::Unit(axis));
      held[body_of(node)] += motion * motion.transpose();
    }
  for (std::size_t c = 0; c < parts; ++c)
    bodies.all.push_back(
        {{volumes[c].begin(), volumes[c].end()}, full(held[c]), sides[c][0], sides[c][2]});
  return bodies;
}

std::string Bodies::name(const mesh::Mesh& mesh, std::size_t body) const
{
  if (all.size() < 2) return {};
  std::string text = "part " + std::to_string(body + 1) + " of " + std::to_string(all.size()) +
                     (all[body].volumes.size() > 1 ? ", volumes" : ", volume");
  for (int volume : all[body].volumes)
    text += " '" + mesh.volumes[static_cast<std::size_t>(volume)] + "'";
  return text;
}

void require_supports(const fem::Dirichlet& fixed, const mesh::Mesh& mesh)
{
  const Bodies bodies = bodies_of(mesh, fixed);
  for (std::size_t b = 0; b < bodies.all.size(); ++b)
    if (!bodies.all[b].held) refuse_free(bodies, mesh, b);
}

void refuse_free(const Bodies& bodies, const mesh::Mesh& mesh, std::size_t body)
{
  const std::string name = bodies.name(mesh, body);
  throw core::option_error(
      "option -fix: the supports leave a rigid motion free, so a static solution does not exist" +
      (name.empty() ? name : " (" + name + ")"));
}

double small_inertia(const Bodies& bodies, const std::vector<Material>& materials)
{
  constexpr double small = 5e-3, thinnest = 1e-3;
  double least = std::numeric_limits<double>::max();
  for (const Body& body : bodies.all)
    for (int volume : body.volumes) {
      const Material& material = materials[static_cast<std::size_t>(volume)];
      const double part =
          std::max(body.thickness, thinnest * body.length) / (body.length * body.length);
      least = std::min(least, material.young / material.density * part * part);
    }
  return small * least;
}

}  // namespace trocar::tissue
