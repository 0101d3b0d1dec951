#include "solve/ksp_step_solver.hpp"

namespace trocar::solve {

KspStepSolver::KspStepSolver(const StepSolverParts& parts, ColumnSolver columns, std::string reason)
    : space_(&parts.space),
      fixed_(&parts.fixed),
      system_(parts.space, parts.pattern, parts.x, parts.linear, parts.ledger),
      compliance_(system_, parts.fixed, columns, parts.ledger),
      reason_(std::move(reason)),
      reuse_(parts.reuse)
{
}

HalfSolution KspStepSolver::begin(const OwnedField& b)
{
  if (!reuse_) compliance_.forget();
  return {system_.solve(b).value};
}

core::VecX KspStepSolver::at(const Probes& probes, const HalfSolution& half)
{
  core::VecX read = core::VecX::Zero(probes.size());
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    const int local = space_->owned_local(probes.nodes[k]);
    if (local >= 0)
      read.segment<3>(3 * static_cast<Eigen::Index>(k)) = half.value.segment<3>(3 * local);
  }
  for (std::size_t k = 0; k < probes.wide.size(); ++k) {
    OwnedField wide = probes.wide[k]->vector;
    fixed_->clear(wide);
    read[static_cast<Eigen::Index>(3 * probes.nodes.size() + k)] = wide.value.dot(half.value);
  }
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, read.data(), static_cast<int>(read.size()), MPI_DOUBLE,
                           MPI_SUM, space_->comm().get()));
  return read;
}

OwnedField KspStepSolver::finish(const HalfSolution& half, const Probes& probes,
                                 const core::VecX& f)
{
  OwnedField u{half.value};
  if (probes.size() == 0) return u;
  OwnedField forces = spread(probes, f, *space_);
  fixed_->clear(forces);
  u.value += system_.solve(forces).value;
  fixed_->clear(u);
  return u;
}

}  // namespace trocar::solve
