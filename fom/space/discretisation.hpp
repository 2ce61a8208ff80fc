// The unknowns of a fluid-structure problem on one cut: spaces, numbering, constraints, ownership. The cut is
// that of the solids at rest, or where they were placed (see recut).
//
// Unknowns in natural order: for every vertex i of the fluid its dim velocity components and its pressure,
// i * (dim + 1) + c; with quadratic velocities then those of the edges' mid-points; then for every solid its
// P2 nodes' velocities, offset + node * dim + c. Velocity nodes count vertices first, then edges.
// Displacements are stored in an array of the same length as the unknowns, at the places of the velocities.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fom/fom.hpp"
#include "fom/problem/problem.hpp"
#include "fom/space/domain_map.hpp"
#include "fom/space/reduced_space.hpp"
#include "fom/space/solid_space.hpp"
#include "geometry/cut/cut.hpp"

namespace undula::fom {

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
  std::vector<SimplexMesh<dim>> placed_solids; ///< meshes of the solids where they were cut
  /// The fluid's domain of this cut is the one of its instant and follows the solids from cut to cut; else
  /// the domain is fixed, or moves by `map`.
  bool interface_moves = false;
  DomainMap<dim> map;                          ///< of the fluid's domain; empty: identity
  std::optional<BackgroundCutter<dim>> cutter; ///< the background, prepared for the cuts of a moving solid
  CutMesh<dim> cut;
  DofSets<dim> fluid_nodes;  ///< vertices
  EdgeSets<dim> fluid_edges; ///< empty with linear velocities
  std::vector<QuadraticSpace<dim>> solid_spaces;
  std::vector<int>
      solid_offset; ///< first unknown of each solid; size solids + 1, the last = number of unknowns
  std::vector<ConstrainedUnknown<dim>> constrained;
  std::vector<ImposedNode<dim>> imposed;
  std::vector<char> is_constrained; ///< by unknown, both kinds
  /// Unknowns of a driven holder (FsiProblem::holder), constrained to have one value. The row of the first
  /// holds the sum of their equations and that of the holder. Empty: no holder is driven.
  std::vector<int> joined;
  std::shared_ptr<const ReducedSpace> reduced; ///< null: all unknowns, all parts and cells

  /// Of a part, and of a cell of all solids, in sums over them.
  double part_weight(int part) const {
    return reduced && !reduced->part_weights.empty() ? reduced->part_weights[static_cast<std::size_t>(part)]
                                                     : 1.0;
  }
  double cell_weight(int solid, int cell) const {
    if (!reduced || reduced->cell_weights.empty()) return 1.0;
    auto place = static_cast<std::size_t>(cell);
    for (int before = 0; before < solid; ++before)
      place += solid_spaces[static_cast<std::size_t>(before)].cell_nodes.size();
    return reduced->cell_weights[place];
  }
  /// Whether sums over parts or cells are those of a cubature: energies and residuals are unknown then.
  bool is_sampled() const {
    return reduced && !(reduced->part_weights.empty() && reduced->cell_weights.empty());
  }
  int fluid_unknowns() const { return solid_offset.front(); }
  int unknowns() const { return solid_offset.back(); }
  int solid_unknowns() const { return unknowns() - fluid_unknowns(); }
  int vertex_nodes() const { return static_cast<int>(fluid_nodes.dof_point.size()); }
  int velocity_nodes() const { return vertex_nodes() + static_cast<int>(fluid_edges.edge_points.size()); }
  int velocity_unknown(int node, int component) const {
    return node * dim + std::min(node, vertex_nodes()) + component;
  }
  /// Where a velocity node is at rest, cm.
  Point<dim> velocity_position(int node) const {
    const auto& points = cut.mesh.points;
    if (node < vertex_nodes()) return points[fluid_nodes.dof_point[node]];
    const auto& ends = fluid_edges.edge_points[node - vertex_nodes()];
    return 0.5 * (points[ends[0]] + points[ends[1]]);
  }
  int pressure_unknown(int node) const { return node * (dim + 1) + dim; }
  int solid_unknown(int solid, int node, int component) const {
    return solid_offset[solid] + node * dim + component;
  }
};

/// Cuts the background, builds spaces and constraints. Throws InputError if a boundary name has no condition.
template <int dim>
Discretisation<dim> discretise(FsiProblem<dim> problem, const CutOptions& options);

/// Cuts the background anew with the solids displaced by `placement`, the displacement of all solid nodes
/// (cm, solid unknowns in their order, without the fluid's), and numbers the unknowns of that cut. Takes
/// problem and solid spaces over from `before`, which keeps its cut and numbering for the transfer of fields.
template <int dim>
Discretisation<dim> recut(Discretisation<dim>& before, const Eigen::VectorXd& placement,
                          const CutOptions& options);

/// Makes sums over all test functions sums over those of the system: 0 in the rows of constrained unknowns,
/// the sum of the joined in the row of the first of them.
template <int dim>
void constrain_rows(const Discretisation<dim>& disc, Eigen::VectorXd& values);

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

} // namespace undula::fom
