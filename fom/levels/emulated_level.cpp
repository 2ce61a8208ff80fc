#include "fom/levels/emulated_level.hpp"

#include <cmath>
#include <filesystem>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/emulator/emulated_curve.hpp"

namespace undula::fom {

rom::EmulatorPoint emulator_point(const OperatingPoint& at) {
  return {at.frequency, at.drive == Drive::voltage ? at.voltage : units::length_to_mm(at.stroke),
          units::pressure_to_mmHg(at.head)};
}

int EmulatedLevel::unknowns() const { return static_cast<int>(emulator_.runs.size()); }

std::vector<CurvePoint> EmulatedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                             const std::function<void()>& on_point) {
  const auto at = emulator_point(scene.operating_point);
  return rom::emulated_curve(emulator_, at[0], at[1], heads_mmHg, on_point);
}

std::vector<std::string> EmulatedLevel::remarks(const Scene& scene,
                                                std::span<const double> heads_mmHg) const {
  const auto at = emulator_point(scene.operating_point);
  return rom::outside_training_box(emulator_, at[0], at[1], heads_mmHg);
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
  const auto& [frequency, range, head] = emulator.inputs;
  at.head = units::pressure_from_mmHg((head.low + head.high) / 2);
  auto& box = scene.training;
  box.frequency_low = frequency.low, box.frequency_high = frequency.high;
  box.head_low = units::pressure_from_mmHg(head.low), box.head_high = units::pressure_from_mmHg(head.high);
  (by_voltage ? box.voltage_low : box.stroke_low) = by_voltage ? range.low : units::length_from_mm(range.low);
  (by_voltage ? box.voltage_high : box.stroke_high) =
      by_voltage ? range.high : units::length_from_mm(range.high);
  return scene;
}

} // namespace undula::fom
