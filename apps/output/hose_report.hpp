// What is printed of a peristaltic pump.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "apps/apps.hpp"
#include "fom/output/step_table.hpp"
#include "geometry/hose/roller_track.hpp"

namespace undula::apps {

/// One row per turn; every period has a turn.
std::string turn_table(std::span<const PeriodSummary> periods);

nlohmann::ordered_json turn_json(const TurnSummary& turn);

/// Lengths and volumes that follow from the keys of a scene.
std::string hose_table(const RollerTrack& track);
nlohmann::ordered_json hose_json(const RollerTrack& track);

} // namespace undula::apps
