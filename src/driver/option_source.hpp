#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "core/csv.hpp"
#include "core/options.hpp"

namespace trocar::driver {

/// What the program was started with.
struct Invocation
{
  std::vector<std::string> arguments;
  std::string options_file;       ///< path, "" when none was given
  std::string options_file_text;  ///< verbatim
};

/// Reads the arguments and the options file; a missing file is a Failure (64). Collective.
Invocation read_invocation(int argc, char** argv, const base::Comm& comm);

/// Gives the arguments to PETSc once more, after its start: PETSc lets an options file win over
/// arguments that stand before it, we let the command line win always.
void apply_arguments(const Invocation& invocation);

/// A CSV file that an option names, read on rank 0 and parsed on every rank. Failure (65).
/// Collective.
core::Csv read_csv(const std::string& file, const base::Comm& comm);

/// Takes every option of our table out of PETSc's database (marking it as used) with the place it
/// came from. Options that are neither ours nor have a prefix PETSc may still read are a
/// Failure (64) that names the nearest one. Not collective: every rank has the same database.
std::map<std::string, core::OptionValue> take_options(const Invocation& invocation);

/// True when the user chose the tissue's solver: some -tissue_ksp_* or -tissue_pc_* is given.
bool tissue_solver_given();

/// Throws Failure (64) when PETSc has not used one of its options either: a misspelt
/// -tissue_ksp_rtoll. To be called after set-up.
void refuse_unused();

}  // namespace trocar::driver
