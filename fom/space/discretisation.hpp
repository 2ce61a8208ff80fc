// The unknowns of a fluid-structure problem on one cut: spaces, numbering, constraints, ownership.
//
// Unknowns in natural order: for every scalar fluid node i its dim velocity components and its pressure,
// i * (dim + 1) + c; then for every solid its P2 nodes' velocities, offset + node * dim + c.
// Displacements are stored in an array of the same length as the unknowns, at the places of the velocities.
#pragma once

#include <span>
#include <vector>

#include "fom/problem.hpp"
#include "fom/space/solid_space.hpp"
#include "geometry/cut.hpp"

namespace undula {

/// A fluid unknown whose value is imposed by boundary condition `condition`.
template <int dim>
struct ConstrainedUnknown {
  int unknown = -1;
  int component = 0;
  Point<dim> position;
  const BoundaryCondition<dim>* condition = nullptr; ///< null: zero
};

/// A solid node whose displacement is imposed.
template <int dim>
struct ImposedNode {
  int solid = -1;
  int unknown = -1; ///< of component 0; the others follow
  Point<dim> position;
};

template <int dim>
struct Discretisation {
  FsiProblem<dim> problem;
  CutMesh<dim> cut;
  DofSets<dim> fluid_nodes;
  std::vector<QuadraticSpace<dim>> solid_spaces;
  std::vector<int>
      solid_offset; ///< first unknown of each solid; size solids + 1, the last = number of unknowns
  std::vector<ConstrainedUnknown<dim>> constrained;
  std::vector<ImposedNode<dim>> imposed;
  std::vector<char> is_constrained; ///< by unknown, both kinds

  int fluid_unknowns() const { return solid_offset.front(); }
  int unknowns() const { return solid_offset.back(); }
  int velocity_unknown(int node, int component) const { return node * (dim + 1) + component; }
  int pressure_unknown(int node) const { return node * (dim + 1) + dim; }
  int solid_unknown(int solid, int node, int component) const {
    return solid_offset[solid] + node * dim + component;
  }
};

/// Cuts the background, builds spaces and constraints. Throws InputError if a boundary name has no condition.
template <int dim>
Discretisation<dim> discretise(FsiProblem<dim> problem, const CutOptions& options);

/// Position of every unknown's node, for partitioning and plots.
template <int dim>
std::vector<Point<dim>> unknown_positions(const Discretisation<dim>& discretisation);

/// Distribution of the unknowns over ranks by recursive coordinate bisection of their nodes.
struct Ownership {
  std::vector<int> owner;       ///< by natural unknown
  std::vector<int> petsc_index; ///< natural -> PETSc (contiguous per rank)
  std::vector<int> first;       ///< PETSc range of rank r is [first[r], first[r + 1])
};

template <int dim>
Ownership distribute_unknowns(const Discretisation<dim>& discretisation, int ranks);

} // namespace undula
