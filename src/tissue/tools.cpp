#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tissue/tissue.hpp"

// Holders of the tissue and their forces. Holders are tools (prescribed displacements of plates,
// clamps or single nodes) and supports.
namespace trocar::tissue {

/// Finds the holder of every held dof. Where two displacements hold a dof, the later one counts, as
/// in `prescribed_displacement`. A displacement counts before a support, and the first support
/// before the others.
void Tissue::find_holders()
{
  std::map<Eigen::Index, std::size_t> owner;
  std::vector<bool> held(static_cast<std::size_t>(space_->owned()), false);
  const auto hold = [&](const std::string& group, const auto& take) {
    for (int node : mesh::group_nodes(*mesh_, group)) {
      const int local = space_->owned_local(node);
      for (int axis = 0; local >= 0 && axis < 3; ++axis)
        if (take(axis, 3 * local + axis)) held[static_cast<std::size_t>(local)] = true;
    }
  };
  const auto& tools = settings_.boundary.displacements;
  const auto& supports = settings_.boundary.fixed;
  for (std::size_t k = 0; k < tools.size(); ++k)
    hold(tools[k].group, [&](int axis, Eigen::Index dof) {
      if (std::isnan(tools[k].value[axis])) return false;
      owner[dof] = k;
      return true;
    });
  for (std::size_t k = 0; k < supports.size(); ++k)
    hold(supports[k].group, [&](int axis, Eigen::Index dof) {
      return (supports[k].axes >> axis & 1U) && owner.emplace(dof, tools.size() + k).second;
    });
  held_dofs_.assign(owner.begin(), owner.end());
  if (held_dofs_.empty()) return;
  for (std::size_t e = 0; e < space_->tets(); ++e)
    for (int node : space_->nodes(e))
      if (node < space_->owned() && held[static_cast<std::size_t>(node)]) {
        held_elements_.push_back(e);
        break;
      }
}

Reactions Tissue::reactions(const TissueState& old, const OwnedField& u, const TimeStep& step,
                            const OwnedField& more) const
{
  // The linearisation point of linear tissue is the same for every u.
  LinearisationPoint here;
  const bool linear = settings_.all_linear();
  if (!linear) elements_->configure_for(held_elements_, space_->with_ghosts(u), here);
  const OwnedField held = forces_of(held_elements_, old, u, linear ? at_ : here, step);
  const std::size_t tools = settings_.boundary.displacements.size();
  const std::size_t count = tools + settings_.boundary.fixed.size();
  core::VecX sums = core::VecX::Zero(3 * static_cast<Eigen::Index>(count));
  for (const auto& [dof, holder] : held_dofs_)
    sums[3 * static_cast<Eigen::Index>(holder) + dof % 3] -= held.value[dof] + more.value[dof];
  space_->comm().sum(sums);
  Reactions found;
  for (std::size_t k = 0; k < count; ++k)
    (k < tools ? found.tools : found.supports)
        .emplace_back(sums.segment<3>(3 * static_cast<Eigen::Index>(k)));
  return found;
}

}  // namespace trocar::tissue
