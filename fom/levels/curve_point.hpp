// One head of a head-flow curve, whatever level computed it.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>

namespace undula::fom {

/// Surface units. NaN: the level does not know the number, or the numerics failed.
struct CurvePoint {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double head_mmHg = 0;
  double flow_l_per_min = unknown; ///< mean out of the outlet; NaN where the numerics failed
  double inflow_l_per_min = unknown;
  double spread_l_per_min = unknown;       ///< largest minus smallest mean of the last periods
  double error_l_per_min = unknown;        ///< |error| that the level expects of itself; infinite: unknown
  std::optional<bool> inside_training_box; ///< of a reduced model; nothing for other levels
  double power_mW = unknown;               ///< hydraulic: head times flow
  double holder_power_mW = unknown;        ///< put in by the actuator
  double speed_max_cm_per_s = unknown, clearance_min_mm = unknown;
  int periods = 0; ///< computed at this head
  bool periodic = false;
  std::string reason;                    ///< why it is not, else empty
  std::map<std::string, double> seconds; ///< by phase, "total" among them
};

} // namespace undula::fom
