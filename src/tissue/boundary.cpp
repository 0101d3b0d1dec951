#include "tissue/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/words.hpp"
#include "law/volume.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::tissue {
namespace {

/// Displacement that a group prescribes along one axis of a node: `value` [m] times the factor
/// `curve` over time. A value of 0 needs no curve.
struct Prescribed
{
  double value = 0.0;
  const std::optional<core::Csv>* curve = nullptr;
  const std::string* group = nullptr;

  bool agrees(const Prescribed& other) const
  {
    if (value != other.value) return false;
    if (value == 0.0) return true;
    const bool both = curve->has_value() && other.curve->has_value();
    return both ? (*curve)->rows == (*other.curve)->rows
                : curve->has_value() == other.curve->has_value();
  }
};

}  // namespace

void refuse_conflicts(const BoundaryConditions& conditions, const mesh::Mesh& mesh)
{
  std::map<std::pair<int, int>, Prescribed> known;  // key: node and axis
  const auto add = [&](int node, int axis, const Prescribed& one) {
    const auto [place, fresh] = known.emplace(std::pair(node, axis), one);
    const Prescribed& other = place->second;
    if (fresh || one.agrees(other)) return;
    const auto moves = [](const Prescribed& by) {
      return "'" + *by.group + "' " +
             (by.value == 0.0 ? "holds it" : "moves it by " + core::shown(by.value) + " m") +
             (by.curve && *by.curve ? " times its curve" : "");
    };
    throw core::data_error(mesh.file + ": node " +
                           std::to_string(mesh.node_tag[static_cast<std::size_t>(node)]) +
                           " is in two groups that disagree along " + "xyz"[axis] + ": " +
                           moves(other) + ", " + moves(one));
  };
  for (const auto& fixed : conditions.fixed)
    for (int node : mesh::group_nodes(mesh, fixed.group))
      for (int axis = 0; axis < 3; ++axis)
        if (fixed.axes >> axis & 1U) add(node, axis, {0.0, nullptr, &fixed.group});
  for (const auto& moved : conditions.displacements)
    for (int node : mesh::group_nodes(mesh, moved.group)) {
      const Vec3& value = moved.field.empty() ? moved.value : moved.field.at(node);
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isnan(value[axis])) add(node, axis, {value[axis], &moved.curve, &moved.group});
    }
}

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

}  // namespace trocar::tissue
