#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/outcome.hpp"
#include "solve/step_solver.hpp"

namespace trocar::solve {

using core::Done;
using core::Outcome;

/// What a factor has served since it was made.
struct FactorAge
{
  bool lags = false;         ///< the operator has moved on
  int uses = 0;              ///< linearisations
  double sweeps = 0.0;       ///< they took in all
  double last_sweeps = 0.0;  ///< and the last one
};

/// A step solver whose factor may be that of an older operator (modified Newton). All solves leave
/// out the fixed dofs. Collective but for what only tells.
class LaggedFactor
{
 public:
  /// Borrows space and fixed set.
  LaggedFactor(std::unique_ptr<StepSolver> solver, const fem::Space& space,
               const fem::Dirichlet& fixed)
      : solver_(std::move(solver)), space_(&space), fixed_(&fixed)
  {
  }

  /// Factors; refused where the operator is not positive definite, or does not fit in memory.
  Outcome<Done> make(const fem::BlockMatrix& values);
  /// The operator has moved on, about by these rotations of the nodes, and the factor stays.
  void keep(const std::vector<core::Mat3>& R);
  /// Another linearisation has the same operator.
  void serve_again();
  /// A linearisation took this many sweeps.
  void served(int sweeps);
  /// Goes on counting from there.
  void set_age(const FactorAge& age)
  {
    age_.uses = age.uses;
    age_.sweeps = age.sweeps;
    age_.last_sweeps = age.last_sweeps;
  }

  bool lags() const { return age_.lags; }
  const FactorAge& age() const { return age_; }
  /// Made anew when the last linearisation took more sweeps than one does on average when the
  /// factor's cost is shared by all that used it: from there on its share no longer falls.
  bool worn() const;
  /// Counts the factors made: compliance columns of one version belong together.
  int version() const { return version_; }

  /// A⁻¹ b on its way, b [N].
  HalfSolution begin(const OwnedField& b);
  /// S A⁻¹ b [m] by slot of the probes.
  core::VecX read(const Probes& probes, const HalfSolution& half)
  {
    return solver_->at(probes, half);
  }
  /// A⁻¹ (b + Sᵀ f) [m], f [N] by slot of the probes; without probes A⁻¹ b.
  OwnedField finish(const HalfSolution& half, const Probes& probes, const core::VecX& f);
  OwnedField answer(const OwnedField& b) { return finish(begin(b), {}, {}); }

  StepSolver& solver() { return *solver_; }
  const StepSolver& solver() const { return *solver_; }
  IsolatedCompliance& compliance() { return solver_->compliance(); }
  const fem::Space& space() const { return *space_; }
  const fem::Dirichlet& fixed() const { return *fixed_; }

 private:
  std::unique_ptr<StepSolver> solver_;
  const fem::Space* space_;
  const fem::Dirichlet* fixed_;
  FactorAge age_;
  int version_ = 0;
};

}  // namespace trocar::solve
