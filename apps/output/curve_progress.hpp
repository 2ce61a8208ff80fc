// A curve, with progress on stderr while it is computed.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/levels/level.hpp"

namespace undula::apps {

/// Level::curve; rank 0 tells the heads that are done under `label`. Collective over `comm`,
/// which is MPI_COMM_NULL without MPI.
std::vector<CurvePoint> curve_with_progress(const std::string& label, Level& level, const Scene& scene,
                                            std::span<const double> heads_mmHg, MPI_Comm comm);

} // namespace undula::apps
