#pragma once

#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "core/ledger.hpp"
#include "fem/block_matrix.hpp"

namespace trocar::solve {

using fem::OwnedField;

/// Prefix of the PETSc options by which the user chooses a solver (`-tissue_ksp_*`,
/// `-tissue_pc_*`). The default is one MUMPS Cholesky solve.
struct LinearSettings
{
  std::string prefix = "tissue_";
};

/// A symmetric positive definite operator A [N/m] on the tissue dofs and its PETSc solver: matrix,
/// KSP with option prefix, near-null space. The row of a prescribed dof is zero except for the
/// diagonal entry of A.
class LinearSystem
{
 public:
  /// x: reference positions of all nodes in file order [m], for the rigid body modes. Collective.
  LinearSystem(const fem::Space& space, const fem::BlockPattern& pattern,
               const std::vector<core::Vec3>& x, const LinearSettings& settings,
               core::Ledger& ledger);

  /// Takes new values and factors (or sets up the preconditioner). Starts a new version. Failure
  /// (70) for a singular operator, (64) for a solver that PETSc does not have. Collective.
  void set_operator(const fem::BlockMatrix& values);

  /// A⁻¹ b [m]; b [N] is zero, or the prescribed value times the diagonal, on fixed dofs. Unsolved
  /// (70) when the Krylov solver does not converge. Collective.
  OwnedField solve(const OwnedField& b);

  /// A⁻¹ rhs [m] for k right-hand sides [N]; `rhs` is (owned dofs x k). Collective.
  core::MatX solve_block(const core::MatX& rhs);

  /// Number of operators set so far. A cached column is exact only if it was made in this version.
  int version() const { return version_; }
  const fem::Space& space() const { return *space_; }

  /// Name of the solver for log and results, such as "preonly + cholesky (mumps)".
  std::string describe() const;
  /// True for a direct solver. Collective.
  bool direct() const;

 private:
  void create_matrix(const fem::BlockPattern& pattern);
  void create_solver();
  void attach_near_null_space(Mat matrix);
  void raise_mumps_workspace(PC pc);
  Mat fill(const fem::BlockMatrix& values);
  void convert();
  void set_up();
  void check_converged(const char* what) const;

  const fem::Space* space_;
  LinearSettings settings_;
  core::Ledger* ledger_;
  base::MatHandle assembled_;  ///< SBAIJ, block size 3
  base::MatHandle converted_;  ///< AIJ copy, only for preconditioners that refuse SBAIJ
  base::KspHandle ksp_;
  base::NullSpaceHandle rigid_modes_;
  std::vector<core::Vec3> x_owned_;
  bool needs_aij_ = false;
  bool fresh_ = true;  ///< no factor yet, or the last factorisation failed
  int version_ = 0;
};

}  // namespace trocar::solve
