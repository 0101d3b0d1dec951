#include "base/petsc.hpp"

#include <mpi.h>

#include <string>

namespace trocar::base {
namespace {

/// The innermost message of the PETSc error being reported, filled by our error handler.
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

PetscSession::PetscSession(int* argc, char*** argv)
{
  check_petsc(PetscInitialize(argc, argv, nullptr, nullptr), "PetscInitialize");
  check_petsc(PetscPushErrorHandler(remember_message, nullptr), "PetscPushErrorHandler");
}

PetscSession::~PetscSession()
{
  if (!std::uncaught_exceptions()) static_cast<void>(PetscFinalize());
}

}  // namespace trocar::base
