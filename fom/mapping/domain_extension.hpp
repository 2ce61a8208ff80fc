// Extension of the solids' displacement into the fluid: the map of the domain that follows the solids.
//
// Component by component d_ext = reach * D. D extends the displacement of the skin smoothly and freely: that
// of an elastic medium with nothing to hold it but the skin, so that the fluid around a tip that turns turns
// along, and with a stiffness against bends (skin_elasticity.hpp). The reach is 1 on the skin and 0 on walls
// and openings, and falls between them as evenly as it can: it minimises the p-norm of its gradient for a
// large p, so that it tends to the extension of least slope (Aronsson 1967), which is linear across a gap and
// has no concentration at the edge of a plate or the lip of an opening. A rigid motion by delta then changes
// a length along delta by no more than about delta / (width of the gap), and the map folds only when a gap
// closes; a harmonic extension (p = 2) folds much earlier. Slopes across the component's own axis only shear
// and count less.
//
// Where it would fold nevertheless, unfolding.hpp corrects it. Linear in the displacement. Works on the nodes
// of the cut, so the two sides of a thin solid are apart.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <memory>
#include <vector>

#include "fom/space/discretisation.hpp"

namespace undula::fom {

struct ExtensionSettings {
  double exponent = 64;      ///< p of the reach; 2 with shear_weight 1: a harmonic reach
  double shear_weight = 0.1; ///< of squared slopes across the component's axis, in (0, 1]
  int sweeps = 8;            ///< linear problems per doubling of the exponent
  double smoothing = 4;      ///< length that D is smoothed over, in mean thicknesses of the solids
};

template <int dim>
struct DomainExtension {
  using Factors = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
  std::unique_ptr<Factors> smooth;        ///< of D, fluid nodes * dim
  Eigen::SparseMatrix<double> data;       ///< fluid nodes * dim x solid unknowns: right-hand side of D
  std::array<Eigen::VectorXd, dim> reach; ///< by component, fluid nodes
};

/// Prepared once per cut, of a domain at rest (no map). The displacement vanishes on walls and openings, its
/// normal component on symmetric boundaries. Throws NumericsError if a factorisation fails.
template <int dim>
DomainExtension<dim> prepare_extension(const Discretisation<dim>& disc,
                                       const ExtensionSettings& settings = {});

/// Displacement of the fluid's nodes (cm) for a displacement of all solid nodes (cm, length
/// disc.solid_unknowns(), the solid unknowns in their order).
template <int dim>
std::vector<Point<dim>> extend(const DomainExtension<dim>& extension,
                               const Eigen::VectorXd& solid_displacement);

} // namespace undula::fom
