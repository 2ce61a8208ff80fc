// The equations of one implicit time step of the thin-gap level and their linearisation.
#pragma once

#include "fom/thin_gap/band_matrix.hpp"
#include "fom/thin_gap/step.hpp"

namespace undula::fom {

/// Left over of every equation at x, in `residual`: flows of pressures (dyn/cm^2), volumes (cm^3/s), forces
/// (dyn, dyn cm), imposed velocities (cm/s). With `matrix`, its derivatives as well. `holder_force` becomes
/// the axial force of the actuator on the imposed nodes, dyn.
void assemble(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
              BandMatrix* matrix, double& holder_force);

} // namespace undula::fom
