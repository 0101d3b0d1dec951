#pragma once

#include <petscksp.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "core/failure.hpp"

namespace trocar::base {

/// Turns a PETSc error code into a Failure (70) that carries PETSc's own words.
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
  /// Where a create call writes; what was owned before is destroyed first.
  Object* out()
  {
    reset();
    return &object_;
  }
  explicit operator bool() const noexcept { return object_ != nullptr; }

 private:
  void reset() noexcept
  {
    // After PetscFinalize nothing may be destroyed any more. While an exception is on its way out
    // nothing may be either: some destroys are collective, and the failure may be this rank's only.
    PetscBool finalized = PETSC_FALSE;
    if (object_ && PetscFinalized(&finalized) == 0 && !finalized && !std::uncaught_exceptions())
      static_cast<void>(Destroy(&object_));  // a failing destroy has no one to tell
    object_ = nullptr;
  }
  Object object_ = nullptr;
};

using VecHandle = Handle<Vec, VecDestroy>;
using MatHandle = Handle<Mat, MatDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using NullSpaceHandle = Handle<MatNullSpace, MatNullSpaceDestroy>;

/// The PETSc session: initialised in the constructor, finalised in the destructor (unless an
/// exception is on its way out: finalising is collective). PETSc's error printing is replaced by
/// `check_petsc`. PETSc's database holds the arguments given here and nothing else: PETSC_OPTIONS
/// and files named petscrc are not looked at.
class PetscSession
{
 public:
  explicit PetscSession(const std::vector<std::string>& arguments);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

}  // namespace trocar::base
