// Preconditioner of the system of one time step by blocks of unknowns, for systems that are too large to be
// factored: PETSc's fieldsplit.
//
//   -fsi_fieldsplit_fluid_, -fsi_fieldsplit_solid_     block Gauss-Seidel, the fluid first (Heil 2004).
//   Without
//                                                      solids the prefix of the fluid is -fsi_ itself.
//   ..._fieldsplit_velocity_, ..._fieldsplit_pressure_ of the fluid: upper factor of the Schur complement,
//                                                      A11 - A10 diag(A00)^-1 A01 in its place
//
// By default the velocity takes ILU(0) of each rank's share, the pressure one V-cycle of BoomerAMG, the solid
// is factored by MUMPS. The diagonal stands for the velocity's block as long as its mass outweighs viscosity
// and convection: in short time steps, and not for steady states.
#pragma once

#include "fom/system/handles.hpp"
#include "fom/system/operators.hpp"

namespace undula::fom {

using PetscIndices = PetscHandle<IS, ISDestroy>;

/// PETSc indices of this rank's share.
struct UnknownBlocks {
  PetscIndices fluid, solid;
  PetscIndices velocity, pressure; ///< in the numbering of the fluid's block
  bool has_solid = false;          ///< on any rank
};

/// Collective.
template <int dim>
UnknownBlocks unknown_blocks(const Discretisation<dim>& disc, const Operators<dim>& operators);

/// Sets the preconditioner of `solver`, whose operator has to be set and filled. Reads the options of its
/// parts. To be called once. Collective.
void precondition_by_blocks(KSP solver, const UnknownBlocks& blocks);

} // namespace undula::fom
