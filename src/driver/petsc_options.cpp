#include "driver/petsc_options.hpp"

#include <algorithm>
#include <cctype>

#include "base/petsc.hpp"
#include "core/failure.hpp"
#include "core/words.hpp"
#include "driver/option_list.hpp"

namespace trocar::driver {
namespace {

const std::vector<std::string> solver_starts{"tissue_ksp_", "tissue_pc_", "tissue_mat_",
                                             "tissue_mg_", "tissue_sub_"};
/// Reports that PETSc prints when the program ends. Without a value they go to the terminal.
const std::vector<std::string> reports{"log_view", "malloc_view", "malloc_dump", "objects_dump"};
const std::vector<std::string> switches{"malloc_debug", "fp_trap"};
/// Options that PETSc looks up only in a solve, so they are still unused after set-up.
const std::vector<std::string> asked_late{"tissue_ksp_view",
                                          "tissue_ksp_view_final_residual",
                                          "tissue_ksp_converged_reason",
                                          "tissue_ksp_converged_rate",
                                          "tissue_ksp_view_mat",
                                          "tissue_ksp_view_pmat",
                                          "tissue_ksp_view_rhs",
                                          "tissue_ksp_view_solution",
                                          "tissue_ksp_view_eigenvalues",
                                          "tissue_ksp_view_singularvalues",
                                          "tissue_pc_view",
                                          "tissue_mat_view"};
/// Common options of the solver, for suggestions after a misspelling.
const std::vector<std::string> frequent{"tissue_ksp_type",
                                        "tissue_ksp_rtol",
                                        "tissue_ksp_atol",
                                        "tissue_ksp_max_it",
                                        "tissue_ksp_monitor",
                                        "tissue_ksp_norm_type",
                                        "tissue_pc_type",
                                        "tissue_pc_factor_mat_solver_type",
                                        "tissue_pc_gamg_threshold",
                                        "tissue_pc_hypre_type",
                                        "tissue_mg_levels_pc_type",
                                        "tissue_mg_levels_ksp_type",
                                        "tissue_mat_mumps_icntl_14",
                                        "tissue_mat_mumps_icntl_7",
                                        "tissue_sub_pc_type"};

bool among(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool of_solver(const std::string& name)
{
  return std::any_of(solver_starts.begin(), solver_starts.end(),
                     [&](const std::string& start) { return name.rfind(start, 0) == 0; });
}

std::string suggestion(const std::string& name)
{
  std::vector<std::string> names{"-options_file", "-help"};
  for (const core::OptionSpec& spec : option_table()) names.push_back("-" + spec.name);
  for (const auto* list : {&reports, &switches, &asked_late, &frequent})
    for (const std::string& one : *list) names.push_back("-" + one);
  return core::did_you_mean("-" + name, names);
}

bool says_yes_or_no(std::string value)
{
  for (char& c : value) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return among({"", "0", "1", "true", "false", "yes", "no", "on", "off"}, value);
}

/// True when all characters are letters, digits or one of "_.,+-".
bool plain(const std::string& text)
{
  return std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string("_.,+-").find(c) != std::string::npos;
  });
}

/// True for options whose value could tell PETSc to write a file or open a window.
bool shows_something(const std::string& name)
{
  return name.find("_view") != std::string::npos || name.find("_monitor") != std::string::npos ||
         name.find("_converged_reason") != std::string::npos ||
         name.find("_converged_rate") != std::string::npos;
}

/// Reason why an option may not be passed to PETSc; "" when it may.
std::string objection(const std::string& name, const std::string& value)
{
  if (among(reports, name))
    return value.empty() ? "" : "it takes no value: its report goes to the terminal";
  if (among(switches, name)) return says_yes_or_no(value) ? "" : "its value is true or false";
  if (!plain(name) || !plain(value)) return "its value must be a number or a plain word";
  for (const std::string* text : {&name, &value}) {
    std::string lower = *text;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower.find("python") != std::string::npos) return "code of others is not run";
    if (lower.find("ooc") != std::string::npos || lower == "tissue_mat_mumps_icntl_22")
      return "the solver would write files of its own";
    // These options choose the Fortran units to which MUMPS writes messages.
    if (among({"tissue_mat_mumps_icntl_1", "tissue_mat_mumps_icntl_2", "tissue_mat_mumps_icntl_3"},
              lower) &&
        value != "0" && value != "6")
      return "MUMPS would write files of its own: 6 is the terminal, 0 nothing";
  }
  // SuperLU_DIST of Debian 12 corrupts memory when a factor is computed again or freed.
  if (value == "superlu_dist") return "SuperLU_DIST would end the run by a crash: take mumps";
  if (shows_something(name) && !among({"", "ascii", "true", "false", "0", "1"}, value))
    return "what is shown goes to the terminal: without a value, or with ascii";
  return "";
}

std::vector<std::string> unused()
{
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  TROCAR_PETSC(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> all(names, names + count);
  TROCAR_PETSC(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return all;
}

}  // namespace

std::vector<std::string> petsc_arguments(const std::vector<core::WrittenOption>& options)
{
  std::vector<std::string> arguments;
  for (const core::WrittenOption& one : options) {
    const std::string value = core::value_of(one, false);
    if (!of_solver(one.name) && !among(reports, one.name) && !among(switches, one.name))
      throw core::option_error(core::label_of(one) + " is unknown" + suggestion(one.name));
    const std::string trouble = objection(one.name, value);
    if (!trouble.empty()) throw core::option_error(core::label_of(one) + ": " + trouble);
    arguments.push_back("-" + one.name);
    if (!value.empty()) arguments.push_back(value);
  }
  return arguments;
}

bool tissue_solver_given()
{
  const std::vector<std::string> names = unused();
  return std::any_of(names.begin(), names.end(), of_solver);
}

void refuse_unused(const std::string& solver)
{
  for (const std::string& name : unused()) {
    if (!of_solver(name) || among(asked_late, name)) continue;
    const bool known = among(frequent, name);
    throw core::option_error("option -" + name +
                             (known ? " means nothing to the tissue's solver, " + solver
                                    : " is unknown" + suggestion(name)));
  }
}

}  // namespace trocar::driver
