#include "apps/output/hose_report.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "apps/output/curve_report.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct Derived {
  const char* key;
  const char* title;
  double value;
};

std::vector<Derived> derived(const RollerTrack& track) {
  constexpr double degrees = 180 / std::numbers::pi;
  return {
      {"centreline_radius_mm", "radius of the centreline (mm)",
       units::length_to_mm(geometry::centreline_radius(track))},
      {"crank_mm", "radius of the rollers' axes (mm)", units::length_to_mm(geometry::crank(track))},
      {"relative_radius_mm", "relative radius of roller and track (mm)",
       units::length_to_mm(geometry::relative_radius(track))},
      {"gap_mm", "bore under a roller (mm)", units::length_to_mm(track.gap)},
      {"squeezed_length_mm", "hose squeezed by a roller (mm)",
       units::length_to_mm(2 * geometry::half_reach(track, track.gap))},
      {"release_deg", "angle in which a roller leaves (deg)", geometry::release_angle(track) * degrees},
      {"missing_volume_ml", "volume missing under a roller (ml)", geometry::missing_volume(track, track.gap)},
      {"closed_volume_per_turn_ml", "volume per turn of a closed pump (ml)",
       geometry::closed_volume_per_turn(track)}};
}

} // namespace

std::string turn_table(std::span<const PeriodSummary> periods) {
  std::vector<std::vector<std::string>> rows;
  for (const PeriodSummary& period : periods) {
    const TurnSummary& turn = *period.turn;
    rows.push_back(
        {std::to_string(period.period), decimals(period.outflow_l_per_min, 4), decimals(turn.volume_ml, 4),
         decimals(period.spread_l_per_min, 4), decimals(turn.leak_l_per_min, 4), decimals(turn.torque_N_m, 4),
         decimals(turn.torque_max_N_m, 4), decimals(period.input_power_mW, 1),
         decimals(turn.outlet_pressure_min_mmHg, 2) + " to " + decimals(turn.outlet_pressure_max_mmHg, 2),
         std::isfinite(turn.roller_force_max_N) ? decimals(turn.roller_force_max_N, 1) : "-",
         decimals(period.speed_max_cm_per_s, 1)});
  }
  return text_table({"turn", "outflow (l/min)", "per turn (ml)", "ripple (l/min)", "leak (l/min)",
                     "torque (N m)", "max torque (N m)", "power (mW)", "outlet pressure (mmHg)",
                     "max roller force (N)", "max speed (cm/s)"},
                    rows);
}

nlohmann::ordered_json turn_json(const TurnSummary& turn) {
  return {{"volume_ml", turn.volume_ml},
          {"leak_l_per_min", turn.leak_l_per_min},
          {"torque_N_m", turn.torque_N_m},
          {"torque_max_N_m", turn.torque_max_N_m},
          {"outlet_pressure_min_mmHg", turn.outlet_pressure_min_mmHg},
          {"outlet_pressure_max_mmHg", turn.outlet_pressure_max_mmHg},
          {"roller_force_max_N", finite_or_null(turn.roller_force_max_N)}};
}

std::string hose_table(const RollerTrack& track) {
  std::vector<std::vector<std::string>> rows;
  for (const Derived& one : derived(track)) {
    rows.push_back({one.title, decimals(one.value, 3)});
  }
  return text_table({"of the rollers and the track", "value"}, rows);
}

nlohmann::ordered_json hose_json(const RollerTrack& track) {
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  for (const Derived& one : derived(track)) {
    result[one.key] = one.value;
  }
  return result;
}

} // namespace undula::apps
