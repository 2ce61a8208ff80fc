// Ownership of PETSc objects, and the translation of PETSc's error codes into exceptions.
#pragma once

#include <petscksp.h>

#include <utility>

namespace undula::fom {

/// Throws NumericsError with PETSc's own text unless `code` is 0.
void check_petsc(PetscErrorCode code, const char* what);

/// Unique owner of a PETSc object; Destroy is collective, so handles die in the same order on all ranks.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class PetscHandle {
public:
  PetscHandle() = default;
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;
  PetscHandle(PetscHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~PetscHandle() {
    if (object_) Destroy(&object_);
  }
  Object get() const { return object_; }
  /// For creation functions that write through a pointer.
  Object* out() { return &object_; }

private:
  Object object_ = nullptr;
};

using PetscMat = PetscHandle<Mat, MatDestroy>;
using PetscVec = PetscHandle<Vec, VecDestroy>;
using PetscSolver = PetscHandle<KSP, KSPDestroy>;
using PetscScatter = PetscHandle<VecScatter, VecScatterDestroy>;

} // namespace undula::fom
