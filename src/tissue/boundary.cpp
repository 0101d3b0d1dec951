#include "tissue/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"
#include "law/volume.hpp"
#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::tissue {

fem::Dirichlet dirichlet_set(const BoundaryConditions& conditions, const mesh::Mesh& mesh,
                             const fem::Space& space)
{
  fem::Dirichlet set(space);
  for (const auto& fixed : conditions.fixed)
    for (int node : mesh::group_nodes(mesh, fixed.group))
      for (int axis = 0; axis < 3; ++axis)
        if (fixed.axes >> axis & 1U) set.fix(node, axis);
  for (const auto& displacement : conditions.displacements)
    for (int node : mesh::group_nodes(mesh, displacement.group))
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isnan(displacement.value[axis])) set.fix(node, axis);
  return set;
}

double load_factor(const std::optional<core::Csv>& curve, double t)
{
  return curve ? core::interpolate(*curve, 1, t) : 1.0;
}

fem::OwnedField prescribed_displacement(const BoundaryConditions& conditions,
                                        const mesh::Mesh& mesh, const fem::Space& space, double t)
{
  fem::OwnedField target = space.zero();
  for (const auto& displacement : conditions.displacements) {
    const double factor = load_factor(displacement.curve, t);
    for (int node : mesh::group_nodes(mesh, displacement.group)) {
      const int local = space.owned_local(node);
      if (local < 0) continue;
      const Vec3& value =
          displacement.field.empty() ? displacement.value : displacement.field.at(node);
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isnan(value[axis])) target.value[3 * local + axis] = factor * value[axis];
    }
  }
  return target;
}

fem::OwnedField traction_load(const mesh::SurfaceGroup& surface, const Vec3& value,
                              const mesh::Mesh& mesh, const fem::Space& space)
{
  fem::OwnedField load = space.zero();
  for (const mesh::Face& face : surface.faces) {
    const std::vector<int> nodes = mesh::nodes_of(mesh, face);
    core::MatX x(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t a = 0; a < nodes.size(); ++a)
      x.col(static_cast<Eigen::Index>(a)) = mesh.x[static_cast<std::size_t>(nodes[a])];
    const core::VecX share = law::face_shares(x);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const int local = space.owned_local(nodes[a]);
      if (local >= 0) load.node(local) += share[static_cast<Eigen::Index>(a)] * value;
    }
  }
  return load;
}

void require_supports(const fem::Dirichlet& fixed, const mesh::Mesh& mesh)
{
  int count = 0;
  const std::vector<int> component = mesh::connected_components(mesh, count);
  // A part is held when its fixed dofs see all six rigid motions: rank of Σ m mᵀ over them.
  std::vector<Eigen::Matrix<double, 6, 6>> held(static_cast<std::size_t>(count),
                                                Eigen::Matrix<double, 6, 6>::Zero());
  std::vector<Vec3> first(static_cast<std::size_t>(count), Vec3::Constant(std::nan("")));
  std::vector<double> size(static_cast<std::size_t>(count), 1e-300);
  for (int node = 0; node < mesh.node_count(); ++node) {
    const auto c = static_cast<std::size_t>(component[static_cast<std::size_t>(node)]);
    const Vec3& x = mesh.x[static_cast<std::size_t>(node)];
    if (first[c].hasNaN()) first[c] = x;
    size[c] = std::max(size[c], (x - first[c]).norm());
  }
  for (int node = 0; node < mesh.node_count(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (!fixed.fixed(node, axis)) continue;
      const auto c = static_cast<std::size_t>(component[static_cast<std::size_t>(node)]);
      const Vec3 arm = (mesh.x[static_cast<std::size_t>(node)] - first[c]) / size[c];
      Eigen::Matrix<double, 6, 1> motion;
      motion << Vec3::Unit(axis), arm.cross(Vec3::Unit(axis));
      held[c] += motion * motion.transpose();
    }
  for (std::size_t c = 0; c < held.size(); ++c) {
    const core::VecX seen = core::symmetric_eigenvalues(core::MatX(held[c]));
    if (seen[0] <= 1e-10 * seen[5])
      throw core::option_error(
          "option -fix: the supports leave a rigid motion free, so a static solution does not "
          "exist" +
          (count > 1 ? " (part " + std::to_string(c + 1) + " of " + std::to_string(count) + ")"
                     : std::string()));
  }
}

}  // namespace trocar::tissue
