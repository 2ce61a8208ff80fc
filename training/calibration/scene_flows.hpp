// Flows of a scene at heads, as numbers to fit and to propagate: what fails is told, not thrown.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "fom/levels/level.hpp"
#include "training/training.hpp"

namespace undula::training {

struct SceneFlows {
  std::vector<double> flow_l_per_min; ///< at every head; NaN where the numerics failed
  std::string failure;                ///< of the first head that failed, or of the preparation; else empty
  int not_periodic = 0;               ///< heads whose flow is a mean over periods that differ
};

/// Flows at `heads_mmHg` (Level::curve), the same on every rank of `comm`, bit for bit. Collective.
SceneFlows scene_flows(Level& level, const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm);

/// The same with its own preparation. What cannot be prepared (InputError: a geometry that its values make
/// impossible; NumericsError) has no flow at any head.
SceneFlows scene_flows(const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm);

} // namespace undula::training
