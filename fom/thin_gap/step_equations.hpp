// The equations of one implicit time step of the thin-gap level and their linearisation.
#pragma once

#include "fom/thin_gap/band_matrix.hpp"
#include "fom/thin_gap/step.hpp"

namespace undula::fom {

/// The holder of one step: the plate's nodes beyond the clamp, which move as one.
struct HolderEquation {
  double force = 0;    ///< dyn, of the holder on membrane and fluid
  double residual = 0; ///< dyn, left over of its equation of motion (fom/actuator), where it is free
  Eigen::VectorXd
      row; ///< derivatives of `residual` by all unknowns, those of the holder's nodes for fixed `velocity`
  double by_velocity = 0; ///< and by the velocity of the whole, dyn s/cm
};

/// Left over of every equation at x, in `residual`: flows of pressures (dyn/cm^2), volumes (cm^3/s), forces
/// (dyn, dyn cm), velocities of the holder's nodes (cm/s), from the imposed one, or from that of the whole.
/// With `matrix`, its derivatives as well, the holder's row left to `holder`.
void assemble(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
              BandMatrix* matrix, HolderEquation& holder);

/// Velocity of the holder in x, cm/s.
double holder_velocity(const ThinGapStep& step, const Eigen::VectorXd& x);

} // namespace undula::fom
