#include "solve/linear_system.hpp"

#include <cstring>

namespace trocar::solve {
namespace {

/// PETSc vector on a borrowed array.
base::VecHandle wrap(const fem::Space& space, const double* values)
{
  base::VecHandle vec;
  if (space.comm().size() == 1)
    TROCAR_PETSC(
        VecCreateSeqWithArray(space.comm().get(), 3, space.owned_dofs(), values, vec.out()));
  else
    TROCAR_PETSC(VecCreateMPIWithArray(space.comm().get(), 3, space.owned_dofs(), PETSC_DETERMINE,
                                       values, vec.out()));
  return vec;
}

base::MatHandle wrap(const fem::Space& space, const core::MatX& columns)
{
  base::MatHandle mat;
  // PETSc takes a mutable pointer even for matrices it only reads.
  TROCAR_PETSC(MatCreateDense(space.comm().get(), space.owned_dofs(), PETSC_DECIDE, PETSC_DETERMINE,
                              static_cast<PetscInt>(columns.cols()),
                              const_cast<double*>(columns.data()), mat.out()));
  return mat;
}

bool is(const char* type, const char* name)
{
  return type && std::strcmp(type, name) == 0;
}

}  // namespace

LinearSystem::LinearSystem(const fem::Space& space, const fem::BlockPattern& pattern,
                           const std::vector<core::Vec3>& x, const LinearSettings& settings,
                           core::Ledger& ledger)
    : space_(&space), settings_(settings), ledger_(&ledger)
{
  for (int local = 0; local < space.owned(); ++local)
    x_owned_.push_back(x[static_cast<std::size_t>(space.file_node(local))]);
  create_matrix(pattern);
  try {
    create_solver();
  } catch (const core::Unsolved&) {
    throw;
  } catch (const core::Failure& failure) {  // an option has a value unknown to PETSc
    throw core::option_error("option -" + settings_.prefix + "…: " + failure.what());
  }
}

void LinearSystem::create_matrix(const fem::BlockPattern& pattern)
{
  std::vector<PetscInt> here, elsewhere;
  const int end = space_->first() + space_->owned();
  for (int row = 0; row < space_->owned(); ++row) {
    PetscInt own = 0, other = 0;
    for (int k = pattern.row_start()[static_cast<std::size_t>(row)];
         k < pattern.row_start()[static_cast<std::size_t>(row) + 1]; ++k)
      ++(pattern.column()[static_cast<std::size_t>(k)] < end ? own : other);
    here.push_back(own);
    elsewhere.push_back(other);
  }
  TROCAR_PETSC(MatCreate(space_->comm().get(), assembled_.out()));
  Mat A = assembled_.get();
  TROCAR_PETSC(
      MatSetSizes(A, space_->owned_dofs(), space_->owned_dofs(), PETSC_DETERMINE, PETSC_DETERMINE));
  TROCAR_PETSC(MatSetBlockSize(A, 3));
  TROCAR_PETSC(MatSetType(A, MATSBAIJ));
  TROCAR_PETSC(MatSeqSBAIJSetPreallocation(A, 3, 0, here.data()));
  TROCAR_PETSC(MatMPISBAIJSetPreallocation(A, 3, 0, here.data(), 0, elsewhere.data()));
  TROCAR_PETSC(MatSetOption(A, MAT_ROW_ORIENTED, PETSC_FALSE));
  TROCAR_PETSC(MatSetOption(A, MAT_SPD, PETSC_TRUE));
}

void LinearSystem::create_solver()
{
  TROCAR_PETSC(KSPCreate(space_->comm().get(), ksp_.out()));
  KSP ksp = ksp_.get();
  TROCAR_PETSC(KSPSetOptionsPrefix(ksp, settings_.prefix.c_str()));
  TROCAR_PETSC(KSPSetType(ksp, KSPPREONLY));
  TROCAR_PETSC(KSPSetTolerances(ksp, 1e-12, 0.0, PETSC_DEFAULT, 10000));
  PC pc = nullptr;
  TROCAR_PETSC(KSPGetPC(ksp, &pc));
  TROCAR_PETSC(PCSetType(pc, PCCHOLESKY));
  TROCAR_PETSC(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  TROCAR_PETSC(KSPSetFromOptions(ksp));

  PetscBool ksp_given = PETSC_FALSE;
  TROCAR_PETSC(PetscOptionsHasName(nullptr, settings_.prefix.c_str(), "-ksp_type", &ksp_given));
  KSPType type = nullptr;
  TROCAR_PETSC(KSPGetType(ksp, &type));
  PCType pc_type = nullptr;
  TROCAR_PETSC(PCGetType(pc, &pc_type));
  const bool factored = is(pc_type, PCCHOLESKY) || is(pc_type, PCLU);
  // With KSPPREONLY one use of an approximate preconditioner would be the whole solve: take CG.
  if (is(type, KSPPREONLY) && !factored) {
    if (ksp_given)
      throw core::option_error("option -" + settings_.prefix + "ksp_type preonly: '" +
                               std::string(pc_type) + "' is no direct solver");
    TROCAR_PETSC(KSPSetType(ksp, KSPCG));
    TROCAR_PETSC(KSPSetFromOptions(ksp));
  }
  MatSolverType package = nullptr;
  if (factored) TROCAR_PETSC(PCFactorGetMatSolverType(pc, &package));
  needs_aij_ = !(is(pc_type, PCCHOLESKY) && is(package, MATSOLVERMUMPS)) &&
               !is(pc_type, PCJACOBI) && !is(pc_type, PCNONE);
}

void LinearSystem::attach_near_null_space(Mat matrix)
{
  if (!rigid_modes_) {
    base::VecHandle coordinates = wrap(*space_, x_owned_.empty() ? nullptr : x_owned_[0].data());
    TROCAR_PETSC(MatNullSpaceCreateRigidBody(coordinates.get(), rigid_modes_.out()));
  }
  TROCAR_PETSC(MatSetNearNullSpace(matrix, rigid_modes_.get()));
}

void LinearSystem::raise_mumps_workspace(PC pc)
{
  PCType pc_type = nullptr;
  TROCAR_PETSC(PCGetType(pc, &pc_type));
  if (!is(pc_type, PCCHOLESKY) && !is(pc_type, PCLU)) return;
  MatSolverType package = nullptr;
  TROCAR_PETSC(PCFactorGetMatSolverType(pc, &package));
  if (!is(package, MATSOLVERMUMPS)) return;
  // The prefix must be set before the factor is made, else MUMPS reads options without the prefix.
  Mat matrix = needs_aij_ ? converted_.get() : assembled_.get();
  TROCAR_PETSC(MatSetOptionsPrefixFactor(matrix, settings_.prefix.c_str()));
  PetscBool given = PETSC_FALSE;
  TROCAR_PETSC(
      PetscOptionsHasName(nullptr, settings_.prefix.c_str(), "-mat_mumps_icntl_14", &given));
  if (given) return;
  TROCAR_PETSC(PCFactorSetUpMatSolverType(pc));
  Mat factor = nullptr;
  TROCAR_PETSC(PCFactorGetMatrix(pc, &factor));
  // Delayed pivots sometimes make MUMPS's estimate of its workspace too small (MUMPS error -9).
  TROCAR_PETSC(MatMumpsSetIcntl(factor, 14, 60));
}

/// Puts the values into the PETSc matrix. Returns the matrix for the KSP: SBAIJ, or its AIJ copy.
Mat LinearSystem::fill(const fem::BlockMatrix& values)
{
  const fem::BlockPattern& pattern = values.pattern();
  Mat A = assembled_.get();
  for (int row = 0; row < space_->owned(); ++row) {
    const auto begin = static_cast<std::size_t>(pattern.row_start()[static_cast<std::size_t>(row)]);
    const auto end =
        static_cast<std::size_t>(pattern.row_start()[static_cast<std::size_t>(row) + 1]);
    const PetscInt number = space_->first() + row;
    TROCAR_PETSC(MatSetValuesBlocked(A, 1, &number, static_cast<PetscInt>(end - begin),
                                     &pattern.column()[begin], &values.values()[9 * begin],
                                     INSERT_VALUES));
  }
  TROCAR_PETSC(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  TROCAR_PETSC(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  if (!needs_aij_) return A;
  convert();
  return converted_.get();
}

void LinearSystem::set_operator(const fem::BlockMatrix& values)
{
  Mat A = fill(values);
  attach_near_null_space(A);
  TROCAR_PETSC(KSPSetOperators(ksp_.get(), A, A));
  PC pc = nullptr;
  TROCAR_PETSC(KSPGetPC(ksp_.get(), &pc));
  if (fresh_) raise_mumps_workspace(pc);
  fresh_ = false;
  set_up();
  ++version_;
  ++ledger_->factorisations;
  PCFailedReason failed = PC_NOERROR;
  TROCAR_PETSC(PCGetFailedReason(pc, &failed));
  const bool out = space_->comm().any(failed == PC_FACTOR_OUTMEMORY || failed == PC_FACTOR_OTHER);
  if (space_->comm().all(failed == PC_NOERROR)) return;
  // The broken factor must not be used again. MUMPS would refuse; other packages would not.
  const std::string solver = describe();
  TROCAR_PETSC(KSPReset(ksp_.get()));
  fresh_ = true;
  if (out)
    throw core::solver_error("no factor of the tissue operator by " + solver +
                             ", most likely for want of memory: take an iterative solver " +
                             "(-tissue_ksp_type cg -tissue_pc_type gamg)");
  throw core::solver_error(
      "the tissue operator could not be factored: it is singular or not "
      "positive definite (are the supports sufficient?)");
}

/// Updates the AIJ copy through a new matrix: on one rank PETSc's conversion into an existing
/// matrix (MAT_REUSE_MATRIX) writes out of bounds.
void LinearSystem::convert()
{
  if (!converted_) {
    TROCAR_PETSC(MatConvert(assembled_.get(), MATAIJ, MAT_INITIAL_MATRIX, converted_.out()));
    TROCAR_PETSC(MatSetOption(converted_.get(), MAT_SPD, PETSC_TRUE));
    return;
  }
  base::MatHandle fresh;
  TROCAR_PETSC(MatConvert(assembled_.get(), MATAIJ, MAT_INITIAL_MATRIX, fresh.out()));
  TROCAR_PETSC(MatCopy(fresh.get(), converted_.get(), SAME_NONZERO_PATTERN));
}

/// Factors, or sets up the preconditioner. Failure (64) when PETSc cannot do so with these options.
void LinearSystem::set_up()
{
  const PetscErrorCode code = KSPSetUp(ksp_.get());
  if (code == PETSC_ERR_MISSING_FACTOR || code == PETSC_ERR_SUP)
    throw core::option_error("option -" + settings_.prefix + "pc_type: PETSc has no " + describe() +
                             " on " + std::to_string(space_->comm().size()) +
                             " ranks (bjacobi and asm take one for each rank)");
  if (code != 0 && version_ == 0) {  // later on the same options have worked before
    try {
      TROCAR_PETSC(code);
    } catch (const core::Failure& failure) {
      throw core::option_error("option -" + settings_.prefix + "…: " + failure.what());
    }
  }
  TROCAR_PETSC(code);
}

void LinearSystem::check_converged(const char* what) const
{
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  TROCAR_PETSC(KSPGetConvergedReason(ksp_.get(), &reason));
  if (reason > 0) return;
  PetscInt iterations = 0;
  TROCAR_PETSC(KSPGetIterationNumber(ksp_.get(), &iterations));
  throw core::Unsolved(std::string(what) + ": the linear solver (" + describe() +
                       ") did not converge: " + KSPConvergedReasons[reason] + " after " +
                       std::to_string(iterations) + " iterations");
}

OwnedField LinearSystem::solve(const OwnedField& b)
{
  OwnedField x = space_->zero();
  const base::VecHandle rhs = wrap(*space_, b.value.data());
  const base::VecHandle solution = wrap(*space_, x.value.data());
  TROCAR_PETSC(KSPSolve(ksp_.get(), rhs.get(), solution.get()));
  ++ledger_->solves;
  check_converged("tissue solve");
  return x;
}

core::MatX LinearSystem::solve_block(const core::MatX& rhs)
{
  core::MatX x = core::MatX::Zero(rhs.rows(), rhs.cols());
  if (!direct()) {  // KSPMatSolve reports the convergence of the last column only
    for (Eigen::Index k = 0; k < rhs.cols(); ++k) x.col(k) = solve({rhs.col(k)}).value;
    return x;
  }
  const base::MatHandle B = wrap(*space_, rhs);
  const base::MatHandle X = wrap(*space_, x);
  for (const base::MatHandle* mat : {&B, &X}) {
    TROCAR_PETSC(MatAssemblyBegin(mat->get(), MAT_FINAL_ASSEMBLY));
    TROCAR_PETSC(MatAssemblyEnd(mat->get(), MAT_FINAL_ASSEMBLY));
  }
  TROCAR_PETSC(KSPMatSolve(ksp_.get(), B.get(), X.get()));
  check_converged("compliance columns");
  return x;
}

bool LinearSystem::direct() const
{
  KSPType type = nullptr;
  TROCAR_PETSC(KSPGetType(ksp_.get(), &type));
  return is(type, KSPPREONLY);
}

std::string LinearSystem::describe() const
{
  KSPType type = nullptr;
  TROCAR_PETSC(KSPGetType(ksp_.get(), &type));
  PC pc = nullptr;
  TROCAR_PETSC(KSPGetPC(ksp_.get(), &pc));
  PCType pc_type = nullptr;
  TROCAR_PETSC(PCGetType(pc, &pc_type));
  std::string text = std::string(type) + " + " + pc_type;
  if (is(pc_type, PCCHOLESKY) || is(pc_type, PCLU)) {
    MatSolverType package = nullptr;
    TROCAR_PETSC(PCFactorGetMatSolverType(pc, &package));
    if (package) text += " (" + std::string(package) + ")";
  }
  return text;
}

}  // namespace trocar::solve
