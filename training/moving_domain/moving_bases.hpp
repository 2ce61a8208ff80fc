// The modes of a moving domain, on the domain at rest.
#pragma once

#include "training/campaign/moving_snapshots.hpp"

namespace undula::training {

/// Modes side by side, in natural order of the unknowns: see ReducedSpace::basis. A mode of the velocities is
/// one field over fluid and solids, so that both move as one; displacements are sums of the same modes over
/// time.
struct MovingBases {
  Eigen::MatrixXd basis;
  int velocity = 0;    ///< proper modes of fluid and solids together
  int lifted = 0;      ///< modes of the displacement, with the flow that such a motion drives from rest
  int supremizers = 0; ///< velocities that the pressure modes drive
  int pressure = 0;    ///< the last columns
  double captured_velocity = 0, captured_displacement = 0, captured_pressure = 0; ///< parts of the energy
};

/// From the snapshots of `runs`. Velocities are measured by the mass, the fluid's and the solids' so that
/// both have the same energy; numbers of modes, or the energy that they may miss, from scene.training. Throws
/// InputError where a boundary moves the fluid, whose modes would not vanish there.
MovingBases build_moving_bases(const PreparedScene& prepared, const Scene& scene,
                               std::span<const RunRecord> runs);

} // namespace undula::training
