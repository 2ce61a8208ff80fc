// Measured head-flow points beside what is computed.
#pragma once

#include <string>

#include "apps/apps.hpp"
#include "fom/scene/scene.hpp"
#include "rom/curve/measured_curve.hpp"

namespace undula::apps {

using rom::ExtractedPoint, rom::extract_points, rom::MeasuredCurve, rom::QuadraticFit, rom::fit_quadratic,
    rom::read_measured_curve;

/// A sentence for the log where the file states another frequency, or another stroke or voltage, whichever
/// drives, than `what` has; empty where it states the same, or nothing. A curve of another operating point
/// says nothing of what it is put beside.
std::string other_operating_point(const MeasuredCurve& curve, const std::string& file,
                                  const std::string& what, const OperatingPoint& point);

/// Logs it, unless it is empty.
void warn_of_other_point(const MeasuredCurve& curve, const std::string& file, const std::string& what,
                         const OperatingPoint& point);

} // namespace undula::apps
