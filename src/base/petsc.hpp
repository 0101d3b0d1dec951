#pragma once

#include <petscksp.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "core/failure.hpp"

namespace trocar::base {

/// Turns a PETSc error code into a Failure (70) with PETSc's own message.
void check_petsc(PetscErrorCode code, const char* call);

/// Turns an MPI error code into a Failure (1).
void check_mpi(int code, const char* call);

#define TROCAR_PETSC(call) ::trocar::base::check_petsc((call), #call)
#define TROCAR_MPI(call) ::trocar::base::check_mpi((call), #call)

/// Owns one PETSc object. Move only; empty until `out()` has been filled by a PETSc create call.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class Handle
{
 public:
  Handle() = default;
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept
  {
    if (this != &other) {
      reset();
      object_ = std::exchange(other.object_, nullptr);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  Object get() const noexcept { return object_; }
  /// Address for a PETSc create call to write to. An object owned before is destroyed first.
  Object* out()
  {
    reset();
    return &object_;
  }
  explicit operator bool() const noexcept { return object_ != nullptr; }

 private:
  void reset() noexcept
  {
    // After PetscFinalize no object may be destroyed. During an exception none may be destroyed
    // either: some destroys are collective, and perhaps only this rank has failed.
    PetscBool finalized = PETSC_FALSE;
    if (object_ && PetscFinalized(&finalized) == 0 && !finalized && !std::uncaught_exceptions())
      static_cast<void>(Destroy(&object_));  // a destructor cannot report an error
    object_ = nullptr;
  }
  Object object_ = nullptr;
};

using VecHandle = Handle<Vec, VecDestroy>;
using MatHandle = Handle<Mat, MatDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using NullSpaceHandle = Handle<MatNullSpace, MatNullSpaceDestroy>;

/// The PETSc session. The constructor initialises PETSc. The destructor finalises PETSc, but not
/// during an exception, because finalising is collective. `check_petsc` replaces PETSc's printing
/// of errors. The options database holds only `arguments`: PETSC_OPTIONS and petscrc files are
/// ignored.
class PetscSession
{
 public:
  explicit PetscSession(const std::vector<std::string>& arguments);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

}  // namespace trocar::base
