#pragma once

#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "core/ledger.hpp"
#include "fem/block_matrix.hpp"

namespace trocar::solve {

using fem::OwnedField;

/// What to look up when the user asked for a solver on the command line (`-tissue_ksp_*`,
/// `-tissue_pc_*`); defaults are one MUMPS Cholesky solve.
struct LinearSettings
{
  std::string prefix = "tissue_";
};

/// One symmetric positive definite operator A [N/m] on the tissue dofs, with its solver: PETSc
/// matrix, KSP with prefix and near-null space. Prescribed dofs are identity rows scaled like A.
class LinearSystem
{
 public:
  /// x: reference positions of all nodes in file order [m], for the rigid body modes. Collective.
  LinearSystem(const fem::Space& space, const fem::BlockPattern& pattern,
               const std::vector<core::Vec3>& x, const LinearSettings& settings,
               core::Ledger& ledger);

  /// Takes new values and factors (or sets up the preconditioner). A singular operator is a
  /// Failure (70). Starts a new version. Collective.
  void set_operator(const fem::BlockMatrix& values);

  /// A⁻¹ b [m]; b in newtons, zero or the scaled prescribed value on fixed dofs. Unsolved (70) when
  /// the Krylov solver does not converge. Collective.
  OwnedField solve(const OwnedField& b);

  /// The columns A⁻¹ e for `rhs` columns held as (owned dofs x k). Collective.
  core::MatX solve_block(const core::MatX& rhs);

  /// Counts the operators this object has held: a cached column is exact iff its version is this.
  int version() const { return version_; }
  const fem::Space& space() const { return *space_; }

  /// "preonly + cholesky (mumps)": for the log and the record.
  std::string describe() const;
  /// True when the solve is a direct one. Collective.
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
  bool fresh_ = true;  ///< nothing is factored, or what was has failed
  int version_ = 0;
};

}  // namespace trocar::solve
