// Cutting a background mesh by solid meshes with exact arithmetic.
#pragma once

#include <string>

#include "geometry/cut_mesh.hpp"

namespace undula {

struct CutOptions {
  int volume_degree = 3;    ///< polynomial degree integrated exactly over cut parts
  int interface_degree = 5; ///< over interface pieces (P2 solid times P1 fluid times r, squared terms)
  int boundary_degree = 3;
  std::string reproducer_directory = "."; ///< where a failing element is written (one-cell reproducer)
};

/// Cuts `background` by the union of `solids`. All combinatorial decisions are exact on the given
/// coordinates; nothing is perturbed; coincident vertices, edges and facets are ordinary input. A part exists
/// if its exact measure is positive, however small. A cell that a solid only touches stays uncut, and carries
/// the interface pieces where the skin lies on its facets. The boundary of the background where a solid lies
/// against it from outside is interface, not boundary.
///
/// Throws NumericsError, naming a reproducer file (see cut_reproducer.hpp), if an element does not add up
/// (sum of parts + solid = element, every part closed, to 1e-10 relative), as with solids that overlap along
/// a skin; and if a cell near a solid is flat or two cells that share a facet lie on one side of it.
template <int dim>
CutMesh<dim> cut_mesh(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
                      const CutOptions& options);

/// Unknowns numbered by ascending background point, those of one point in a row.
template <int dim>
DofSets<dim> build_dof_sets(const CutMesh<dim>& cut);

} // namespace undula
