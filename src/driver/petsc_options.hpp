#pragma once

#include <string>
#include <vector>

#include "core/option_text.hpp"

namespace trocar::driver {

/// Arguments for the start of PETSc: options of the tissue's linear solver and a few reports and
/// switches. Throws Failure (64) for every other option, and for values with which PETSc would
/// write files or run code.
std::vector<std::string> petsc_arguments(const std::vector<core::WrittenOption>& options);

/// True when the user gave an option of the tissue's PETSc solver, such as -tissue_ksp_* or
/// -tissue_pc_*. Looks for options that PETSc has not used yet, so call it before the solver is set
/// up.
bool tissue_solver_given();

/// Throws Failure (64) for a solver option that PETSc has not used: a misspelt name such as
/// -tissue_ksp_rtoll, or an option that `solver` does not look up. Call it after set-up.
void refuse_unused(const std::string& solver);

}  // namespace trocar::driver
