#include "tissue/tissue.hpp"

// Stress and energies of a state, computed only on request.
namespace trocar::tissue {

StressField Tissue::stresses(const OwnedField& u) const
{
  const auto u_g = space_->with_ghosts(u);
  LinearisationPoint at;
  configure(u_g, at);
  const StressField mine = elements_->stresses(at, u_g);
  const Eigen::Index tets = mesh_->tet_count();
  StressField field{core::VecX::Zero(6 * tets),
                    core::VecX::Zero(mesh_->quadratic() ? 24 * tets : 0), core::VecX::Zero(tets)};
  for (std::size_t e = 0; e < space_->tets(); ++e) {
    if (space_->nodes(e)[0] >= space_->owned()) continue;  // counted by the owner of its first node
    const auto local = static_cast<Eigen::Index>(e);
    const Eigen::Index tet = space_->file_tet(e);
    field.stress.segment<6>(6 * tet) = mine.stress.segment<6>(6 * local);
    field.energy[tet] = mine.energy[local];
    if (mesh_->quadratic())
      field.corner.segment<24>(24 * tet) = mine.corner.segment<24>(24 * local);
  }
  for (core::VecX* values : {&field.stress, &field.corner, &field.energy})
    space_->comm().merge(*values);
  ++ledger_->stress_evaluations;
  return field;
}

Work Tissue::work(const TissueState& old, const TissueState& past, const TissueState& next,
                  const TimeStep& step, const OwnedField& push) const
{
  Kinematics motion{space_->with_ghosts(next.u), {}, {}};
  if (!step.is_static) motion.v = space_->with_ghosts(next.v);
  LinearisationPoint at;
  configure(motion.u, at);
  const TetWork mine = elements_->work(at, motion);
  Work work;
  work.elastic = space_->comm().sum(mine.elastic);
  work.kinetic = space_->comm().sum(mine.kinetic);
  work.damped =
      space_->comm().sum(step.h * (mine.damping_power_mass + mine.damping_power_stiffness));
  // Work of the loads and of moving supports. The force of a support is what balances the other
  // forces on its dofs.
  const OwnedField moved{next.u.value - old.u.value};
  OwnedField support{-forces(past, next.u, at, step).value - push.value};
  OwnedField elsewhere = support;
  fixed_.clear(elsewhere);
  support.value -= elsewhere.value;
  work.supplied = space_->dot(external(step), moved) + space_->dot(support, moved);
  return work;
}

}  // namespace trocar::tissue
