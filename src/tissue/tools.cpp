#include <map>

#include "tissue/element.hpp"

// Prescribed displacements as tools: plates, clamps, single nodes, and the forces they take.
namespace trocar::tissue {

/// A dof that two conditions hold belongs to the later one, whose value it takes.
void Tissue::find_tools()
{
  std::map<Eigen::Index, std::size_t> owner;
  for (std::size_t k = 0; k < settings_.boundary.displacements.size(); ++k) {
    const PrescribedDisplacement& tool = settings_.boundary.displacements[k];
    for (int node : mesh::group_nodes(*mesh_, tool.group)) {
      const int local = space_->owned_local(node);
      for (int axis = 0; local >= 0 && axis < 3; ++axis)
        if (!std::isnan(tool.value[axis])) owner[3 * local + axis] = k;
    }
  }
  tool_dofs_.assign(owner.begin(), owner.end());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (int node : space_->tets()[e].nodes) {
      const auto at = owner.lower_bound(3 * node);
      if (at == owner.end() || at->first > 3 * node + 2) continue;
      tool_elements_.push_back(e);
      break;
    }
}

std::vector<Vec3> Tissue::tool_forces(const TissueState& old, const OwnedField& u,
                                      const TimeStep& step, const OwnedField& more) const
{
  std::vector<Mat3> R(elements_.size(), Mat3::Identity());
  const auto u_g = space_->with_ghosts(u);
  for (std::size_t e : tool_elements_)
    if (settings_.model == Model::corotational)
      R[e] = core::polar_rotation(
          Mat3::Identity() +
          nodal_gradient(elements_[e].shape, nodal_values(u_g, space_->tets()[e])));
  const OwnedField held = forces(old, u, R, step, nullptr, &tool_elements_);
  const std::size_t count = settings_.boundary.displacements.size();
  core::VecX sums = core::VecX::Zero(3 * static_cast<Eigen::Index>(count));
  for (const auto& [dof, tool] : tool_dofs_)
    sums[3 * static_cast<Eigen::Index>(tool) + dof % 3] -= held.value[dof] + more.value[dof];
  space_->comm().sum(sums);
  std::vector<Vec3> tools;
  for (std::size_t k = 0; k < count; ++k)
    tools.emplace_back(sums.segment<3>(3 * static_cast<Eigen::Index>(k)));
  return tools;
}

}  // namespace trocar::tissue
