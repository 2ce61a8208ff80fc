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

/// Cuts `background` by the union of `solids`. All combinatorial decisions are exact on the given coordinates;
/// nothing is perturbed. Throws NumericsError, naming a reproducer file, if the parts of an element do not
/// close (sum of parts + solid = element to 1e-10 relative).
template <int dim>
CutMesh<dim> cut_mesh(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
                      const CutOptions& options);

template <int dim>
DofSets<dim> build_dof_sets(const CutMesh<dim>& cut);

} // namespace undula
