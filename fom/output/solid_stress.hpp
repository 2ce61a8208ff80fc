// Stress in the solids, for pictures.
#pragma once

#include <vector>

#include "fom/space/discretisation.hpp"

namespace undula::fom {

/// Von Mises' stress (of Cauchy's stress, dyn/cm^2) at the quadratic nodes of all solids, one after the
/// other: the mean over the cells of a node. Damping is left out. `d`: displacements in natural order, cm.
template <int dim>
std::vector<double> von_mises_stress(const Discretisation<dim>& disc, const Eigen::VectorXd& d);

} // namespace undula::fom
