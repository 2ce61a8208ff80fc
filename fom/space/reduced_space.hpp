// A subspace that the unknowns are sought in, and the few parts and cells whose weighted sums stand for the
// sums over all of them: empirical cubature (energy-conserving sampling and weighting; Farhat, Chapman &
// Avery, Int. J. Numer. Meth. Eng. 102, 2015). What belongs to a part are its volume, its pieces of interface
// and the facets that it is the first part of.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace undula::fom {

struct ReducedSpace {
  /// Unknowns in natural order x modes; 0 in the rows of constrained unknowns, those of joined unknowns are
  /// equal. Without columns: all unknowns.
  Eigen::MatrixXd basis;
  std::vector<double> part_weights; ///< >= 0, by part of the cut; empty: all 1
  std::vector<double> cell_weights; ///< >= 0, by cell of solid after solid; empty: all 1
};

} // namespace undula::fom
