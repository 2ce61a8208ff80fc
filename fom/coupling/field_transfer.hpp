// From one cut to the next: values of nodal fields on the unknowns of a new cut.
//
// Unknowns that stand at the same background point on the same side of the solids keep their values. New
// ones, in the band that the interface has laid bare since, are extended through the ghost penalty: they
// minimise the jumps of the normal derivative over the facets around them, so that the polynomials next to
// the band go on smoothly (Burman, Frei & Massing, Numer. Math. 150, 2022; Lehrenfeld & Olshanskii, ESAIM:
// M2AN 53, 2019).
#pragma once

#include <Eigen/SparseCholesky>

#include "fom/assembly/sparse.hpp"
#include "fom/space/discretisation.hpp"

namespace undula::fom {

template <int dim>
class FieldTransfer {
public:
  /// `before` needs its cut and numbering only (see recut); both only during construction.
  FieldTransfer(const Discretisation<dim>& before, const Discretisation<dim>& now);

  /// Unknowns of a state (velocities, pressures) on the cut now from those on the cut before: fluid by
  /// transfer, solids as they are. New fluid that no facet connects to the old takes the velocity of the
  /// skin.
  Eigen::VectorXd unknowns(const Eigen::VectorXd& before) const;

  /// Displacements likewise: those of the solids as they are, nothing in the fluid.
  Eigen::VectorXd displacements(const Eigen::VectorXd& before) const;

  /// Number of scalar fluid nodes that are new.
  int extended() const { return static_cast<int>(new_nodes_.size()); }

private:
  int fluid_before_ = 0, fluid_now_ = 0, solids_ = 0; ///< unknowns
  std::vector<int> source_;                           ///< by fluid node now: node before, or -1
  std::vector<int> new_nodes_;
  /// Right-hand side of the extension: new nodes x (fluid nodes now, then the solids' scalar nodes).
  SparseMatrix coupling_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> extension_;
};

} // namespace undula::fom
