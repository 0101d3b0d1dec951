#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solve/isolated_compliance.hpp"

namespace trocar::solve {

/// Solver for the tissue's operator and its isolated compliance.
enum class Provider {
  /// `supernodal` when its factor fits in memory and its interface is not too large, else
  /// `ksp_block`. The driver takes `ksp` instead when the user gave PETSc solver options.
  automatic,
  supernodal,
  ksp,       ///< one PETSc solve per isolated dof, the paper's route
  ksp_block  ///< PETSc solves for up to 64 right-hand sides at a time
};

/// An unfinished solution of A u = b. With a supernodal factor only the forward half-sweep is done,
/// so that constraint forces can be added before the backward half-sweep. With PETSc it is A⁻¹ b.
struct HalfSolution
{
  core::VecX value{};
  core::VecX interface {
  };  ///< the same on the interface dofs, on rank 0
};

/// Solver for one operator A of the tissue. A step first begins with b, then reads A⁻¹ b at the
/// probes, gets the compliance of the probes, and finishes with the forces on the probes. All calls
/// are collective. Results other than fields are equal on every rank.
class StepSolver
{
 public:
  virtual ~StepSolver() = default;

  /// Takes new values and factors. Failure (70) for an operator that is not positive definite.
  virtual void set_operator(const fem::BlockMatrix& values) = 0;
  /// Starts solving A u = b, with b [N] zero on fixed dofs.
  virtual HalfSolution begin(const OwnedField& b) = 0;
  /// S A⁻¹ b [m] by slot of the probes; 0 on fixed dofs.
  virtual core::VecX at(const Probes& probes, const HalfSolution& half) = 0;
  /// A⁻¹ (b + Sᵀ f) [m], f [N] by slot of the probes. Without probes A⁻¹ b.
  virtual OwnedField finish(const HalfSolution& half, const Probes& probes,
                            const core::VecX& f) = 0;
  virtual IsolatedCompliance& compliance() = 0;
  /// For an operator that has become about R A Rᵀ, with R the rotations of the nodes in file order.
  /// From now on every answer uses R A⁻¹ Rᵀ with the present factor of A. Only where `can_turn`.
  virtual void turn(const std::vector<core::Mat3>& /*R*/) {}
  virtual bool can_turn() const { return false; }
  /// Cost of a factorisation in sweeps, estimated from operation counts.
  virtual double sweeps_per_factor() const { return 0.0; }
  /// Memory of the factor [B]; 0 when PETSc holds the factor.
  virtual double factor_bytes() const { return 0.0; }
  /// Total memory of solving, estimated from the analysis [B]; 0 when PETSc solves.
  virtual double memory_bytes() const { return 0.0; }
  /// Number of interface dofs between the domains of the ranks. Rank 0 eliminates them.
  virtual int shared_dofs() const { return 0; }
  /// Name of the solver for log and results, with the reason for a fallback.
  virtual std::string describe() const = 0;
};

/// What a step solver is made from. Borrows everything.
struct StepSolverParts
{
  const fem::Space& space;
  const fem::BlockPattern& pattern;
  const fem::Dirichlet& fixed;
  const std::vector<core::Vec3>& x;  ///< reference positions of all nodes in file order [m]
  /// File nodes that rows are expected to touch. They are eliminated last, so that their
  /// compliance columns cost next to nothing.
  const std::vector<int>& ordered_last;
  bool reuse;          ///< keep columns from step to step while the operator is the same
  double most_memory;  ///< most memory for `supernodal` [B]; 0: part of the free memory
  bool turns;          ///< the operator turns: count a copy of the factor in single precision
  LinearSettings linear;
  core::Ledger& ledger;
};

/// The solver of a provider. `automatic` says in `describe` why it fell back. Collective.
std::unique_ptr<StepSolver> make_step_solver(Provider provider, const StepSolverParts& parts);

}  // namespace trocar::solve
