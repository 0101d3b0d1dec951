#pragma once

#include "solve/step_solver.hpp"

namespace trocar::solve {

/// Step solver by PETSc KSP, on any number of ranks. `begin` solves for b; `finish` solves once
/// more, for the forces on the probes. There are no half-sweeps.
class KspStepSolver final : public StepSolver
{
 public:
  KspStepSolver(const StepSolverParts& parts, ColumnSolver columns, std::string reason);

  void set_operator(const fem::BlockMatrix& values) override { system_.set_operator(values); }
  HalfSolution begin(const OwnedField& b) override;
  core::VecX at(const Probes& probes, const HalfSolution& half) override;
  OwnedField finish(const HalfSolution& half, const Probes& probes, const core::VecX& f) override;
  IsolatedCompliance& compliance() override { return compliance_; }
  std::string describe() const override { return system_.describe() + reason_; }

 private:
  const fem::Space* space_;
  const fem::Dirichlet* fixed_;
  LinearSystem system_;
  KspCompliance compliance_;
  std::string reason_;
  bool reuse_;
};

}  // namespace trocar::solve
