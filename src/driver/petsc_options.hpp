#pragma once

#include <string>
#include <vector>

#include "core/option_text.hpp"

namespace trocar::driver {

/// What PETSc's database gets, as arguments of its start: options of the tissue's linear solver and
/// a few that report. Throws Failure (64) for every other one, and for values with which PETSc
/// would write files or run code.
std::vector<std::string> petsc_arguments(const std::vector<core::WrittenOption>& options);

/// True when the user chose the tissue's solver: some -tissue_ksp_* or -tissue_pc_* is given.
bool tissue_solver_given();

/// Throws Failure (64) when PETSc has not used one of its options: a misspelt -tissue_ksp_rtoll, or
/// one that `solver` does not ask for. To be called after set-up.
void refuse_unused(const std::string& solver);

}  // namespace trocar::driver
