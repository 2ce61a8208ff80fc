#include "fom/levels/emulated_level.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <span>

#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/emulator/emulated_curve.hpp"

namespace undula::fom {

rom::EmulatorPoint emulator_point(const rom::Emulator& emulator, const OperatingPoint& at) {
  rom::EmulatorPoint point = {at.frequency,
                              at.drive == Drive::voltage ? at.voltage : units::length_to_mm(at.stroke),
                              units::pressure_to_mmHg(at.head)};
  for (const auto& input : rom::further_inputs(emulator)) {
    const auto there = at.varied.find(input.name);
    point.push_back(there != at.varied.end() ? there->second : input.stated);
  }
  return point;
}

namespace {

/// Force per volt of a scene in parts of that of the runs; 1 where the emulator does not know theirs.
double force_scale(const rom::Emulator& emulator, const Scene& scene) {
  return emulator.force_N_per_V > 0 ? surface_value(scene, force_key) / emulator.force_N_per_V : 1;
}

} // namespace

rom::EmulatorPoint emulator_point(const rom::Emulator& emulator, const Scene& scene) {
  auto point = emulator_point(emulator, scene.operating_point);
  point[1] *= force_scale(emulator, scene);
  for (std::size_t i = rom::point_inputs; i < point.size(); ++i)
    point[i] = surface_value(scene, emulator.inputs[i].name);
  return point;
}

std::vector<std::string> emulated_keys(const rom::Emulator& emulator) {
  std::vector<std::string> keys;
  if (emulator.force_N_per_V > 0) keys.emplace_back(force_key);
  for (const auto& input : rom::further_inputs(emulator)) keys.push_back(input.name);
  return keys;
}

int EmulatedLevel::unknowns() const { return static_cast<int>(emulator_.runs.size()); }

std::vector<CurvePoint> EmulatedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                             const std::function<void()>& on_point) {
  const auto at = emulator_point(emulator_, scene);
  auto points = rom::emulated_curve(emulator_, at[0], at[1], heads_mmHg, on_point,
                                    std::span(at).subspan(rom::point_inputs));
  if (force_scale(emulator_, scene) == 1) return points;
  // The same force from another voltage: the coil's own power is not known.
  for (auto& point : points) {
    point.electrical_power_mW = std::numeric_limits<double>::quiet_NaN();
    point.efficiency_percent = efficiency_percent(point);
  }
  return points;
}

std::vector<std::string> EmulatedLevel::remarks(const Scene& scene,
                                                std::span<const double> heads_mmHg) const {
  const auto at = emulator_point(emulator_, scene);
  return rom::outside_training_box(emulator_, at[0], at[1], heads_mmHg,
                                   std::span(at).subspan(rom::point_inputs));
}

Scene scene_of_emulator(const rom::Emulator& emulator, const std::string& file, double frequency_Hz,
                        const std::optional<double>& stroke_mm, const std::optional<double>& voltage_V) {
  const bool by_voltage = emulator.driven_by_voltage;
  const double drive = rom::drive_of({stroke_mm, voltage_V}, by_voltage, "the emulator", file);
  if (!std::isfinite(frequency_Hz) || frequency_Hz <= 0)
    throw InputError("no operating point: frequency (Hz)", plain_number(frequency_Hz), "a finite number > 0",
                     file);
  Scene scene;
  scene.name = std::filesystem::path(file).stem().string();
  auto& at = scene.operating_point;
  at.frequency = frequency_Hz;
  at.drive = by_voltage ? Drive::voltage : Drive::stroke;
  (by_voltage ? at.voltage : at.stroke) = by_voltage ? drive : units::length_from_mm(drive);
  const auto &frequency = emulator.inputs[0], &range = emulator.inputs[1], &head = emulator.inputs[2];
  at.head = units::pressure_from_mmHg((head.low + head.high) / 2);
  auto& box = scene.training;
  box.frequency_low = frequency.low, box.frequency_high = frequency.high;
  box.head_low = units::pressure_from_mmHg(head.low), box.head_high = units::pressure_from_mmHg(head.high);
  (by_voltage ? box.voltage_low : box.stroke_low) = by_voltage ? range.low : units::length_from_mm(range.low);
  (by_voltage ? box.voltage_high : box.stroke_high) =
      by_voltage ? range.high : units::length_from_mm(range.high);
  if (emulator.force_N_per_V > 0) set_value(scene, force_key, emulator.force_N_per_V);
  for (const auto& input : rom::further_inputs(emulator)) set_value(scene, input.name, input.stated);
  return scene;
}

} // namespace undula::fom
