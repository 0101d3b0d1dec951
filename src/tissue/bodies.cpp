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

/// Smallest and largest coordinates of a body.
struct Box
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 high = Vec3::Constant(std::numeric_limits<double>::lowest());
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
  std::vector<Box> box(parts);
  std::vector<std::set<int>> volumes(parts);
  const auto body_of = [&](int node) {
    return static_cast<std::size_t>(bodies.of_node[static_cast<std::size_t>(node)]);
  };
  for (int node = 0; node < mesh.node_count(); ++node) {
    Box& mine = box[body_of(node)];
    mine.low = mine.low.cwiseMin(mesh.x[static_cast<std::size_t>(node)]);
    mine.high = mine.high.cwiseMax(mesh.x[static_cast<std::size_t>(node)]);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    volumes[body_of(mesh.tets[t][0])].insert(mesh.region[t]);
  std::vector<Motions> held(parts, Motions::Zero());
  for (int node = 0; node < mesh.node_count(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (!fixed.fixed(node, axis)) continue;
      const Box& mine = box[body_of(node)];
      const Vec3 arm = (mesh.x[static_cast<std::size_t>(node)] - mine.low) /
                       std::max((mine.high - mine.low).norm(), 1e-300);
      Eigen::Matrix<double, 6, 1> motion;
      motion << Vec3::Unit(axis), arm.cross(Vec3::Unit(axis));
      held[body_of(node)] += motion * motion.transpose();
    }
  for (std::size_t c = 0; c < parts; ++c)
    bodies.all.push_back({{volumes[c].begin(), volumes[c].end()},
                          full(held[c]),
                          (box[c].high - box[c].low).minCoeff()});
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
  constexpr double part = 1e-3;
  double least = std::numeric_limits<double>::max();
  for (const Body& body : bodies.all)
    for (int volume : body.volumes) {
      const Material& material = materials[static_cast<std::size_t>(volume)];
      least = std::min(least, material.young / (material.density * body.extent * body.extent));
    }
  return part * least;
}

}  // namespace trocar::tissue
