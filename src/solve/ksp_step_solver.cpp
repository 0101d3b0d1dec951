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
  OwnedField free{half.value};
  fixed_->clear(free);
  return read(probes, free, *space_);
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
