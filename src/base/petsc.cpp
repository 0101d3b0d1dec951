#include "base/petsc.hpp"

#include <mpi.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace trocar::base {
namespace {

/// Message of the last PETSc error at its origin, stored by `remember_message`.
std::string& last_petsc_message()
{
  static std::string message;
  return message;
}

PetscErrorCode remember_message(MPI_Comm, int, const char* function, const char*,
                                PetscErrorCode code, PetscErrorType type, const char* text, void*)
{
  if (type == PETSC_ERROR_INITIAL)
    last_petsc_message() = std::string(function ? function : "?") + ": " + (text ? text : "");
  return code;
}

}  // namespace

void check_petsc(PetscErrorCode code, const char* call)
{
  if (code == 0) return;
  std::string text = last_petsc_message();
  for (char& c : text)
    if (c == '\n') c = ' ';
  throw core::solver_error("PETSc: " + (text.empty() ? std::string(call) : text) + " (error " +
                           std::to_string(code) + ")");
}

void check_mpi(int code, const char* call)
{
  if (code == MPI_SUCCESS) return;
  throw core::Failure(core::ExitCode::internal,
                      std::string("MPI: ") + call + " failed with " + std::to_string(code));
}

PetscSession::PetscSession(const std::vector<std::string>& arguments)
{
  unsetenv("PETSC_OPTIONS");
  unsetenv("PETSC_OPTIONS_YAML");
  std::vector<std::string> words{"trocar", "-skip_petscrc", "-no_signal_handler"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  char** start = pointers.data();
  check_petsc(PetscInitialize(&count, &start, nullptr, nullptr), "PetscInitialize");
  check_petsc(PetscPushErrorHandler(remember_message, nullptr), "PetscPushErrorHandler");
  for (const char* ours : {"-skip_petscrc", "-no_signal_handler"})
    check_petsc(PetscOptionsClearValue(nullptr, ours), "PetscOptionsClearValue");
}

PetscSession::~PetscSession()
{
  if (!std::uncaught_exceptions()) static_cast<void>(PetscFinalize());
}

}  // namespace trocar::base
