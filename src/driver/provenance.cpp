#include "driver/provenance.hpp"

#include <hdf5.h>

#include "base/petsc.hpp"
#include "core/date.hpp"
#include "core/words.hpp"
#include "driver/build_info.hpp"

namespace trocar::driver {
namespace {

std::string petsc_version()
{
  return std::to_string(PETSC_VERSION_MAJOR) + "." + std::to_string(PETSC_VERSION_MINOR) + "." +
         std::to_string(PETSC_VERSION_SUBMINOR);
}

std::string mpi_version()
{
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  return {text, static_cast<std::size_t>(length)};
}

/// All options in PETSc's database, such as those of the solvers, as one line.
std::string petsc_options()
{
  char* text = nullptr;
  TROCAR_PETSC(PetscOptionsGetAll(nullptr, &text));
  const std::string all = text;
  TROCAR_PETSC(PetscFree(text));
  return all;
}

}  // namespace

std::string build_description()
{
  return std::string("trocar ") + build_info::version + " (" + build_info::git_commit + ", " +
         build_info::build_type + ", " + build_info::compiler + "), PETSc " + petsc_version();
}

std::string restart_note(const io::Checkpoint& from, const Invocation& invocation)
{
  return core::utc_now() + ": after step " + std::to_string(from.time.accepted) +
         ", t = " + core::shown(from.time.now) + " s, by " + build_description() + ": " +
         core::join(invocation.arguments, " ");
}

io::Provenance provenance(const step::Model& model, const Invocation& invocation,
                          const std::vector<core::ResolvedOption>& options,
                          const std::string& solver)
{
  io::Provenance p;
  p.texts = {{"program", "trocar"},
             {"version", build_info::version},
             {"git_commit", build_info::git_commit},
             {"build_type", build_info::build_type},
             {"compiler", build_info::compiler},
             {"created_utc", core::utc_now()},
             {"command_line", core::join(invocation.arguments, " ")},
             {"mpi_ranks", std::to_string(model.space.comm().size())},
             {"petsc_version", petsc_version()},
             {"hdf5_version", H5_VERS_INFO},
             {"mpi_version", mpi_version()},
             {"options_file_name", invocation.options_file},
             {"options_file", invocation.options_file_text},
             {"petsc_options", petsc_options()},
             {"tissue_solver", solver},
             {"mesh_file", model.scene.mesh.file},
             {"mesh_hash_fnv1a", model.scene.mesh.hash}};
  std::vector<std::string> names, values, units, sources;
  for (const core::ResolvedOption& option : options) {
    names.push_back(option.name);
    values.push_back(option.value);
    units.push_back(option.unit);
    sources.push_back(option.source);
  }
  p.tables = {{"options/name", names},
              {"options/value", values},
              {"options/unit", units},
              {"options/source", sources}};
  return p;
}

}  // namespace trocar::driver
