// What a pump does over a period, as table, JSON and picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fom/scene/scene.hpp"
#include "rom/emulator/emulator.hpp"

namespace undula::apps {

using fom::OperatingPoint;

struct PeriodQuantity {
  std::string name, unit;
  std::vector<double> places_mm;
  rom::PeriodResponse response;
};

struct PeriodReport {
  std::vector<PeriodQuantity> quantities;
};

/// Everything that the emulator knows of a period at a point.
PeriodReport period_report(const rom::Emulator& emulator, const rom::EmulatorPoint& point);

/// A row per phase: the phase in degrees, then each quantity, at its innermost and outermost place.
std::string period_table(const PeriodReport& report);

/// All places and phases.
std::string period_json(const PeriodReport& report, const OperatingPoint& point);

/// The membrane at eight phases with its envelope, and the outflow.
void plot_period(const std::filesystem::path& picture, const PeriodReport& report,
                 const OperatingPoint& point);

} // namespace undula::apps
