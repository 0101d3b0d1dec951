#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/outcome.hpp"
#include "solve/step_solver.hpp"

namespace trocar::solve {

using core::Done;
using core::Outcome;

/// What a factor has been used for since it was made. A sweep is two half-sweeps.
struct FactorAge
{
  bool lags = false;         ///< the factor is that of an earlier operator
  int uses = 0;              ///< linearisations that used the factor
  double sweeps = 0.0;       ///< sweeps of these linearisations together
  double last_sweeps = 0.0;  ///< sweeps of the last linearisation
};

/// A step solver whose factor may be that of an older operator (modified Newton). Fixed dofs are
/// cleared in right-hand sides and answers. Solving and factoring are collective.
class LaggedFactor
{
 public:
  /// Borrows the space and the fixed dofs.
  LaggedFactor(std::unique_ptr<StepSolver> solver, const fem::Space& space,
               const fem::Dirichlet& fixed)
      : solver_(std::move(solver)), space_(&space), fixed_(&fixed)
  {
  }

  /// Factors the operator. Refused where it is not positive definite or does not fit in memory.
  Outcome<Done> make(const fem::BlockMatrix& values);
  /// Keeps the factor for a new operator. R: rotations of the nodes (file order) that turn the
  /// factored operator into about the new one.
  void keep(const std::vector<core::Mat3>& R);
  /// Counts another linearisation with the same operator.
  void serve_again();
  /// Counts the sweeps that a linearisation took.
  void served(int sweeps);
  /// Sets all counts; `lags` stays.
  void set_age(const FactorAge& age)
  {
    age_.uses = age.uses;
    age_.sweeps = age.sweeps;
    age_.last_sweeps = age.last_sweeps;
  }

  bool lags() const { return age_.lags; }
  const FactorAge& age() const { return age_; }
  /// True when a new factor pays: the last linearisation took more sweeps than the average cost per
  /// linearisation (all sweeps and the factorisation, counted in sweeps, over the uses). From then
  /// on keeping the factor would raise that average.
  bool worn() const;
  /// Number of factors made so far. Columns of different versions must not be mixed.
  int version() const { return version_; }

  /// Starts solving for A⁻¹ b, b [N].
  HalfSolution begin(const OwnedField& b);
  /// S A⁻¹ b [m] by slot of the probes.
  core::VecX read(const Probes& probes, const HalfSolution& half)
  {
    return solver_->at(probes, half);
  }
  /// A⁻¹ (b + Sᵀ f) [m] from `begin(b)`, with f [N] by slot of the probes. Without probes A⁻¹ b.
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
