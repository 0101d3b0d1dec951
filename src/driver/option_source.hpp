#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "core/csv.hpp"
#include "core/options.hpp"

namespace trocar::driver {

/// What the program was started with; the same on every rank.
struct Invocation
{
  std::vector<std::string> arguments;
  std::string options_file;       ///< paths as given, joined by commas; "" when none was
  std::string options_file_text;  ///< verbatim, of all of them in turn
  std::map<std::string, core::OptionValue> given;  ///< options of our table
  std::vector<std::string> petsc;                  ///< arguments for PETSc
  std::vector<std::string> outdated{};             ///< old names that options came under
};

/// Reads the arguments, the environment and the options files, which may name others. Of an option
/// that is given more than once the command line's value is taken before PETSC_OPTIONS' and that
/// before the files', the last one of each. Files that options name are looked for in the working
/// folder and then beside the options file; their values are the paths that were found. What is
/// neither ours nor PETSc's, words without an option, files that are not there or include
/// themselves: Failure (64) with file and line. Collective.
Invocation read_invocation(int argc, char** argv, const base::Comm& comm);

/// A CSV file that an option names, read on rank 0 and parsed on every rank. Failure (65).
/// Collective.
core::Csv read_csv(const std::string& file, const base::Comm& comm);

}  // namespace trocar::driver
