// Pressures along a squeezed hose at an instant, and what they and the wall do to the rollers.
#pragma once

#include <vector>

#include "fom/long_wave/hose_flow.hpp"

namespace undula::fom {

/// Pressure over the inlet reservoir's, piecewise linear along the hose.
struct HosePressures {
  std::vector<double> position; ///< cm from the inlet, ascending
  std::vector<double> pressure; ///< dyn/cm^2
  [[nodiscard]] double at(double where) const;
};

/// From the outlet's pressure inwards: friction, acceleration of the outflow (cm^3/s^2), Bernoulli along the
/// flow relative to a roller up to its throat, and what is recovered behind it. What the motion of a gap adds
/// to the acceleration under a roller is left out.
HosePressures hose_pressures(const HoseModel& model, const HoseInstant& instant, double head, double outflow,
                             double acceleration);

/// Force on the roller that carries most, dyn: the wall pressed flat (flattened_ring.hpp, every cross-section
/// by itself) and the fluid's pressure on the flat part. The model has a ring.
double largest_roller_force(const HoseModel& model, const HoseInstant& instant,
                            const HosePressures& pressures);

} // namespace undula::fom
