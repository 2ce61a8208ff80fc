// The curve of a projected model in the form that all levels give.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "rom/curve/curve_point.hpp"
#include "rom/curve/hq_curve.hpp"

namespace undula::rom {

/// hq_curve as CurvePoints, in the order of the heads; the stroke in mm. `on_point` after every point; what
/// it throws ends the curve. Throws as hq_curve.
std::vector<CurvePoint> projected_curve(const Model& model, double frequency_Hz, double stroke_mm,
                                        std::span<const double> heads_mmHg,
                                        const std::function<void()>& on_point = {});

} // namespace undula::rom
