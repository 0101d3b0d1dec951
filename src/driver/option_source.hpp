#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "core/csv.hpp"
#include "core/options.hpp"

namespace trocar::driver {

/// How the program was started. Equal on every rank; `arguments` are those of the rank itself.
struct Invocation
{
  std::vector<std::string> arguments;
  std::string options_file;       ///< paths of the options files, joined by commas; "": none
  std::string options_file_text;  ///< texts of these files, one behind the other
  std::map<std::string, core::OptionValue> given;  ///< options of `option_table`
  std::vector<std::string> petsc;                  ///< arguments for PETSc, see `petsc_arguments`
  std::vector<std::string> outdated{};             ///< old names of options that the user gave
};

/// Reads the command line, PETSC_OPTIONS and the options files, which may name more options files.
/// If an option is given more than once, the command line wins over PETSC_OPTIONS, and
/// PETSC_OPTIONS wins over the files. Within one of them the last value wins. A file that an option
/// names is looked for in the working folder, then in the folder of the options file; the value
/// becomes the path that was found. Throws Failure (64) with file and line for an option that
/// neither this program nor PETSc takes, for words before the first option, and for options files
/// that do not exist or include themselves. Collective.
Invocation read_invocation(int argc, char** argv, const base::Comm& comm);

/// The contents of a file that an option names, up to 16 MB: rank 0 reads it. Failure (65).
/// Collective.
std::string read_bytes(const std::string& file, const base::Comm& comm);

/// Reads a CSV file that an option names: rank 0 reads it, every rank parses it. Failure (65).
/// Collective.
core::Csv read_csv(const std::string& file, const base::Comm& comm);

}  // namespace trocar::driver
