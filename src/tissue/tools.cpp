#include <cmath>
#include <map>

#include "tissue/tissue.hpp"

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
  for (std::size_t e = 0; e < space_->tets(); ++e)
    for (int node : space_->nodes(e)) {
      const auto at = owner.lower_bound(3 * node);
      if (at == owner.end() || at->first > 3 * node + 2) continue;
      tool_elements_.push_back(e);
      break;
    }
}

std::vector<Vec3> Tissue::tool_forces(const TissueState& old, const OwnedField& u,
                                      const TimeStep& step, const OwnedField& more) const
{
  Configuration at;
  elements_->configure_for(tool_elements_, space_->with_ghosts(u), at);
  const OwnedField held = forces_of(tool_elements_, old, u, at, step);
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
