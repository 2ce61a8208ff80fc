// Cutting a background mesh by solid meshes, with exact decisions.
#pragma once

#include <memory>
#include <string>

#include "geometry/cut/cut_mesh.hpp"

namespace undula::geometry {

struct CutOptions {
  int volume_degree = 3;    ///< polynomial degree integrated exactly over cut parts
  int interface_degree = 5; ///< over interface pieces (P2 solid times P1 fluid times r, squared terms)
  int boundary_degree = 3;
  std::string reproducer_directory = "."; ///< where a failing element is written (one-cell reproducer)
  /// Every cell in exact arithmetic: the reference of the cut in floating point.
  bool exact = false;

  bool operator==(const CutOptions&) const = default;
};

/// A background with the topology of the solids that cut it: all that does not change when solids move.
template <int dim>
class BackgroundCutter {
public:
  /// `solids` give the connectivity; where they are does not matter. Throws NumericsError if a cell of the
  /// background is flat or inverted, or a solid is folded.
  BackgroundCutter(SimplexMesh<dim> background, std::span<const SimplexMesh<dim>> solids,
                   const CutOptions& options);

  /// Cuts the background by the union of the solids where they are placed now. All combinatorial decisions
  /// are exact on the given coordinates; nothing is perturbed; coincident vertices, edges and facets are
  /// ordinary input. A decision is a sign of floating-point numbers where a bound of the rounding error
  /// makes it certain; cells around one that is not certain are cut in exact arithmetic. A part exists if its
  /// exact measure is positive, however small. A cell that a solid only touches stays uncut, and carries the
  /// interface pieces where the skin lies on its facets. The boundary of the background where a solid lies
  /// against it from outside is interface, not boundary.
  ///
  /// Throws InputError if `solids` have another connectivity. Throws NumericsError if a solid is placed at
  /// no number, a cell of it is flat or inverted, or the skins of solids cross in the plane; and, naming
  /// a reproducer file (see cut_reproducer.hpp), if an element does not add up (sum of parts + solid =
  /// element, every part closed, to 1e-10 relative), as with solids that overlap.
  CutMesh<dim> cut(std::span<const SimplexMesh<dim>> solids) const;

  const CutOptions& options() const;

  struct Setup;

private:
  std::shared_ptr<const Setup> setup_;
};

/// One cut: BackgroundCutter(background, solids, options).cut(solids).
template <int dim>
CutMesh<dim> cut_mesh(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
                      const CutOptions& options);

/// Unknowns numbered by ascending background point, those of one point in a row.
template <int dim>
DofSets<dim> build_dof_sets(const CutMesh<dim>& cut);

/// Unknowns numbered by ascending pairs of background points.
template <int dim>
EdgeSets<dim> build_edge_sets(const CutMesh<dim>& cut);

} // namespace undula::geometry
