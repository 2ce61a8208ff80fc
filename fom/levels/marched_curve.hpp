// The head-flow curve of a level that marches: the periodic state at every head.
#pragma once

#include "fom/levels/periodic_run.hpp"

namespace undula::fom {

/// The point that a run at a head comes to: means of its last period where it is periodic, else of its last
/// three.
CurvePoint curve_point(const PeriodicRun& run, double head_mmHg);

/// The curve at `heads_mmHg`, in their order; `on_point` after every point. Every head from rest; where the
/// level goes from head to head, upwards instead, the first from rest, the others from the last state of the
/// one before, or from the line through the last two. A NumericsError ends a point, not the curve.
/// Collective; complete on every rank.
std::vector<CurvePoint> marched_curve(MarchingLevel& level, const Scene& scene,
                                      std::span<const double> heads_mmHg,
                                      const std::function<void()>& on_point);

} // namespace undula::fom
