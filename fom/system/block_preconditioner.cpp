#include "fom/system/block_preconditioner.hpp"

#include <array>
#include <vector>

namespace undula::fom {

namespace {

void set_indices(MPI_Comm comm, const std::vector<PetscInt>& indices, PetscIndices& out) {
  check_petsc(ISCreateGeneral(comm, static_cast<PetscInt>(indices.size()), indices.data(), PETSC_COPY_VALUES,
                              out.out()),
              "naming a block of unknowns");
}

PC preconditioner_of(KSP solver) {
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner), "getting a preconditioner");
  return preconditioner;
}

/// Velocity and pressure by the Schur complement.
void precondition_fluid(KSP solver, const UnknownBlocks& blocks) {
  PC fluid = preconditioner_of(solver);
  check_petsc(PCSetType(fluid, PCFIELDSPLIT), "splitting the fluid");
  check_petsc(PCFieldSplitSetIS(fluid, "velocity", blocks.velocity.get()), "splitting the fluid");
  check_petsc(PCFieldSplitSetIS(fluid, "pressure", blocks.pressure.get()), "splitting the fluid");
  check_petsc(PCFieldSplitSetType(fluid, PC_COMPOSITE_SCHUR), "splitting the fluid");
  check_petsc(PCFieldSplitSetSchurFactType(fluid, PC_FIELDSPLIT_SCHUR_FACT_UPPER), "splitting the fluid");
  check_petsc(PCFieldSplitSetSchurPre(fluid, PC_FIELDSPLIT_SCHUR_PRE_SELFP, nullptr), "splitting the fluid");
  check_petsc(PCSetFromOptions(fluid), "reading -fsi_ options");
  check_petsc(PCSetUp(fluid), "splitting the fluid");
  PetscInt count = 0;
  KSP* parts = nullptr;
  check_petsc(PCFieldSplitSchurGetSubKSP(fluid, &count, &parts), "splitting the fluid");
  check_petsc(KSPSetType(parts[1], KSPPREONLY), "preconditioning the pressure");
  check_petsc(PCSetType(preconditioner_of(parts[1]), PCHYPRE), "preconditioning the pressure");
  for (PetscInt k = 0; k < count; ++k) check_petsc(KSPSetFromOptions(parts[k]), "reading -fsi_ options");
  check_petsc(static_cast<PetscErrorCode>(PetscFree(parts)), "splitting the fluid");
}

} // namespace

template <int dim>
UnknownBlocks unknown_blocks(const Discretisation<dim>& disc, const Operators<dim>& operators) {
  const auto& ownership = operators.ownership;
  const int first = ownership.first[operators.rank], last = ownership.first[operators.rank + 1];
  enum class Kind { velocity, pressure, solid };
  std::vector<Kind> kind_of(static_cast<std::size_t>(last - first), Kind::velocity);
  const auto set_kind = [&](int unknown, Kind kind) {
    if (ownership.owner[unknown] == operators.rank)
      kind_of[static_cast<std::size_t>(ownership.petsc_index[unknown] - first)] = kind;
  };
  for (int node = 0; node < disc.vertex_nodes(); ++node)
    set_kind(disc.pressure_unknown(node), Kind::pressure);
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown)
    set_kind(unknown, Kind::solid);

  std::vector<PetscInt> fluid, solid, velocity, pressure;
  for (std::size_t k = 0; k < kind_of.size(); ++k) {
    const auto index = static_cast<PetscInt>(k) + first;
    if (kind_of[k] == Kind::solid) {
      solid.push_back(index);
      continue;
    }
    (kind_of[k] == Kind::velocity ? velocity : pressure).push_back(static_cast<PetscInt>(fluid.size()));
    fluid.push_back(index);
  }
  PetscInt own = static_cast<PetscInt>(fluid.size()), before = 0;
  MPI_Exscan(&own, &before, 1, MPIU_INT, MPI_SUM, operators.comm);
  if (operators.rank == 0) before = 0;
  for (auto* part : {&velocity, &pressure})
    for (auto& index : *part) index += before;

  UnknownBlocks blocks;
  blocks.has_solid = disc.solid_unknowns() > 0;
  set_indices(operators.comm, fluid, blocks.fluid);
  set_indices(operators.comm, solid, blocks.solid);
  set_indices(operators.comm, velocity, blocks.velocity);
  set_indices(operators.comm, pressure, blocks.pressure);
  return blocks;
}

void precondition_by_blocks(KSP solver, const UnknownBlocks& blocks) {
  if (!blocks.has_solid) {
    precondition_fluid(solver, blocks);
    return;
  }
  PC outer = preconditioner_of(solver);
  check_petsc(PCSetType(outer, PCFIELDSPLIT), "splitting fluid and solid");
  check_petsc(PCFieldSplitSetIS(outer, "fluid", blocks.fluid.get()), "splitting fluid and solid");
  check_petsc(PCFieldSplitSetIS(outer, "solid", blocks.solid.get()), "splitting fluid and solid");
  check_petsc(PCFieldSplitSetType(outer, PC_COMPOSITE_MULTIPLICATIVE), "splitting fluid and solid");
  check_petsc(PCSetFromOptions(outer), "reading -fsi_ options");
  check_petsc(PCSetUp(outer), "splitting fluid and solid");
  PetscInt count = 0;
  KSP* parts = nullptr;
  check_petsc(PCFieldSplitGetSubKSP(outer, &count, &parts), "splitting fluid and solid");
  const std::array<KSP, 2> fluid_and_solid{parts[0], parts[1]};
  check_petsc(static_cast<PetscErrorCode>(PetscFree(parts)), "splitting fluid and solid");
  precondition_fluid(fluid_and_solid[0], blocks);
  PC solid = preconditioner_of(fluid_and_solid[1]);
  check_petsc(PCSetType(solid, PCLU), "factoring the solid");
  check_petsc(PCFactorSetMatSolverType(solid, MATSOLVERMUMPS), "factoring the solid");
  for (const KSP part : fluid_and_solid) check_petsc(KSPSetFromOptions(part), "reading -fsi_ options");
}

template UnknownBlocks unknown_blocks(const Discretisation<2>&, const Operators<2>&);

template UnknownBlocks unknown_blocks(const Discretisation<3>&, const Operators<3>&);

} // namespace undula::fom
