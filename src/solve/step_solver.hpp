#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solve/isolated_compliance.hpp"

namespace trocar::solve {

/// How the tissue's operator is solved with and its isolated compliance made.
enum class Provider {
  automatic,  ///< `supernodal` when its factor fits in memory and no PETSc solver was asked for
  supernodal,
  ksp,       ///< one PETSc solve per isolated dof, the paper's route
  ksp_block  ///< PETSc solves with many right-hand sides
};

/// A⁻¹ b on its way: with a factor only the forward half is done, so that the forces of the
/// constraints can join before the backward half.
struct HalfSolution
{
  core::VecX value{};
  core::VecX interface {
  };  ///< on rank 0: the same on dofs that ranks share
};

/// One operator of the tissue in the order of a step: solve b, read the answer at the probes, get
/// the compliance of the probes, finish with forces on them. All calls are collective; all answers
/// but fields are equal on every rank.
class StepSolver
{
 public:
  virtual ~StepSolver() = default;

  /// Takes new values and factors. Failure (70) for an operator that is not positive definite.
  virtual void set_operator(const fem::BlockMatrix& values) = 0;
  /// b [N], zero on fixed dofs.
  virtual HalfSolution begin(const OwnedField& b) = 0;
  /// S A⁻¹ b [m] by slot of the probes; 0 on fixed dofs.
  virtual core::VecX at(const Probes& probes, const HalfSolution& half) = 0;
  /// A⁻¹ (b + Sᵀ f) [m], f [N] by slot of the probes. No probes: A⁻¹ b.
  virtual OwnedField finish(const HalfSolution& half, const Probes& probes,
                            const core::VecX& f) = 0;
  virtual IsolatedCompliance& compliance() = 0;
  /// The operator has become about R A Rᵀ, R the rotations of the nodes in file order: from now on
  /// every answer is R A⁻¹ Rᵀ with the factor as it is. Only for solvers that can.
  virtual void turn(const std::vector<core::Mat3>& /*R*/) {}
  virtual bool can_turn() const { return false; }
  /// About how many sweeps cost as much as a factorisation, by counts of their work.
  virtual double sweeps_per_factor() const { return 0.0; }
  /// Memory of a factor of our own [B], 0 when PETSc keeps it.
  virtual double factor_bytes() const { return 0.0; }
  /// What solving will take in all, estimated from the analysis [B]; 0 when PETSc does it.
  virtual double memory_bytes() const { return 0.0; }
  /// Dofs between the domains of the ranks, which one of them eliminates.
  virtual int shared_dofs() const { return 0; }
  /// For the log and the record.
  virtual std::string describe() const = 0;
};

/// What a step solver is made from. Borrows everything.
struct StepSolverParts
{
  const fem::Space& space;
  const fem::BlockPattern& pattern;
  const fem::Dirichlet& fixed;
  const std::vector<core::Vec3>& x;  ///< reference positions of all nodes in file order [m]
  /// File nodes that will be probed: put last in the factor, where their columns cost next to
  /// nothing.
  const std::vector<int>& ordered_last;
  bool reuse;          ///< keep columns from step to step while the operator stays
  double most_memory;  ///< that solving ourselves may take [B], 0: a part of what is free
  bool turns;          ///< the operator turns: a copy of the factor in single precision as well
  LinearSettings linear;
  core::Ledger& ledger;
};

/// The solver of a provider. `automatic` says in `describe` why it fell back. Collective.
std::unique_ptr<StepSolver> make_step_solver(Provider provider, const StepSolverParts& parts);

}  // namespace trocar::solve
