#include "driver/option_source.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/petsc.hpp"
#include "core/words.hpp"
#include "driver/option_list.hpp"

namespace trocar::driver {
namespace {

/// Words of `text` that start with a dash and a letter, without the dash.
std::vector<std::string> dashed_words(const std::string& text)
{
  std::vector<std::string> words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    for (std::string word; cells >> word;) {
      if (word.front() == '#') break;
      if (word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])))
        words.push_back(word.substr(1));
    }
  }
  return words;
}

bool holds(const std::vector<std::string>& words, const std::string& name)
{
  for (const std::string& word : words)
    if (word == name) return true;
  return false;
}

/// Names of the PETSc options people give most, for suggestions only.
std::vector<std::string> known_names()
{
  std::vector<std::string> names;
  for (const core::OptionSpec& spec : option_table()) names.push_back("-" + spec.name);
  for (const char* name :
       {"ksp_type", "ksp_rtol", "ksp_atol", "ksp_max_it", "ksp_monitor", "ksp_view",
        "ksp_converged_reason", "ksp_norm_type", "pc_type", "pc_factor_mat_solver_type",
        "pc_gamg_threshold", "pc_hypre_type", "mg_levels_pc_type", "mg_levels_ksp_type",
        "mat_mumps_icntl_14", "mat_mumps_icntl_7", "sub_pc_type"})
    names.push_back(std::string("-tissue_") + name);
  names.insert(names.end(), {"-log_view", "-options_file", "-help", "-options_view"});
  return names;
}

struct Unused
{
  std::vector<std::string> names, values;
};

Unused unused_options()
{
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  TROCAR_PETSC(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  Unused unused;
  for (PetscInt i = 0; i < count; ++i) {
    unused.names.emplace_back(names[i]);
    unused.values.emplace_back(values[i] ? values[i] : "");
  }
  TROCAR_PETSC(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return unused;
}

bool in_table(const std::string& name)
{
  for (const core::OptionSpec& spec : option_table())
    if (core::matches(spec, name)) return true;
  return false;
}

}  // namespace

Invocation read_invocation(int argc, char** argv, const base::Comm& comm)
{
  Invocation invocation;
  for (int i = 0; i < argc; ++i) invocation.arguments.emplace_back(argv[i]);
  for (std::size_t i = 1; i + 1 < invocation.arguments.size(); ++i)
    if (invocation.arguments[i] == "-options_file")
      invocation.options_file = invocation.arguments[i + 1];
  if (!invocation.arguments.empty() && invocation.arguments.back() == "-options_file")
    throw core::option_error("option -options_file: a file name must follow");
  base::on_root(comm, [&] {
    const char* environment = std::getenv("PETSC_OPTIONS");
    std::istringstream words(environment ? environment : "");
    for (std::string word, file; words >> word;)
      if (word == "-options_file" && words >> file && !std::ifstream(file))
        throw core::option_error("PETSC_OPTIONS: -options_file: no such file '" + file + "'");
    if (invocation.options_file.empty()) return;
    std::ifstream stream(invocation.options_file);
    if (!stream)
      throw core::option_error("option -options_file: no such file '" + invocation.options_file +
                               "'");
    std::ostringstream text;
    text << stream.rdbuf();
    invocation.options_file_text = text.str();
  });
  comm.broadcast(invocation.options_file_text);
  return invocation;
}

void apply_arguments(const Invocation& invocation)
{
  const auto& words = invocation.arguments;
  const auto is_name = [&](std::size_t i) {
    return i < words.size() && words[i].size() > 1 && words[i][0] == '-' &&
           std::isalpha(static_cast<unsigned char>(words[i][1]));
  };
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!is_name(i) || words[i] == "-options_file") continue;
    const bool has_value = i + 1 < words.size() && !is_name(i + 1);
    TROCAR_PETSC(PetscOptionsSetValue(nullptr, words[i].c_str(),
                                      has_value ? words[i + 1].c_str() : nullptr));
  }
}

core::Csv read_csv(const std::string& file, const base::Comm& comm)
{
  std::string text;
  base::on_root(comm, [&] {
    std::ifstream stream(file);
    if (!stream) throw core::data_error(file + ": no such CSV file");
    std::ostringstream all;
    all << stream.rdbuf();
    text = all.str();
  });
  comm.broadcast(text);
  return core::parse_csv(text, file);
}

std::map<std::string, core::OptionValue> take_options(const Invocation& invocation)
{
  const char* environment = std::getenv("PETSC_OPTIONS");
  const auto from_environment = dashed_words(environment ? environment : "");
  const auto from_file = dashed_words(invocation.options_file_text);
  std::map<std::string, core::OptionValue> given;
  const Unused options = unused_options();
  for (std::size_t i = 0; i < options.names.size(); ++i) {
    const std::string& name = options.names[i];
    if (!in_table(name)) continue;
    std::string source = "petscrc";
    if (holds(invocation.arguments, "-" + name))
      source = "command line";
    else if (holds(from_environment, name))
      source = "PETSC_OPTIONS";
    else if (holds(from_file, name))
      source = "options file";
    PetscBool found = PETSC_FALSE;
    char ignored[2];
    TROCAR_PETSC(PetscOptionsGetString(nullptr, nullptr, ("-" + name).c_str(), ignored,
                                       sizeof ignored, &found));
    given[name] = {options.values[i], source};
  }
  return given;
}

bool tissue_solver_given()
{
  for (const std::string& name : unused_options().names)
    for (const char* start : {"tissue_ksp_", "tissue_pc_", "tissue_mat_"})
      if (name.rfind(start, 0) == 0) return true;
  return false;
}

void refuse_unused()
{
  for (const std::string& name : unused_options().names) {
    if (in_table(name)) continue;
    throw core::option_error("option -" + name + " is unknown" +
                             core::did_you_mean("-" + name, known_names()));
  }
}

}  // namespace trocar::driver
