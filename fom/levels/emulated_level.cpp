#include "fom/levels/emulated_level.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>

#include "fom/levels/emulated_quantities.hpp"
#include "fom/levels/marched_curve.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/hq_curve.hpp"

namespace undula::fom {

rom::EmulatorPoint emulator_point(const OperatingPoint& at) {
  return {at.frequency, at.drive == Drive::voltage ? at.voltage : units::length_to_mm(at.stroke),
          units::pressure_to_mmHg(at.head)};
}

int EmulatedLevel::unknowns() const { return static_cast<int>(emulator_.runs.size()); }

std::vector<CurvePoint> EmulatedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                             const std::function<void()>& on_point) {
  std::vector<CurvePoint> points;
  auto at = emulator_point(scene.operating_point);
  for (const double head : heads_mmHg) {
    at[2] = head;
    const auto begin = std::chrono::steady_clock::now();
    const auto answer = rom::emulate(emulator_, at);
    CurvePoint point;
    point.head_mmHg = head;
    for (std::size_t q = 0; q < answer.values.size(); ++q)
      for (const auto& column : emulated_columns)
        if (emulator_.quantities[q].name == column.name) point.*column.value = answer.values[q].value;
    point.inflow_l_per_min = point.flow_l_per_min;
    point.error_l_per_min = answer.values.front().error;
    point.inside_training_box = answer.inside_training_box;
    point.power_mW = units::power_to_mW(units::pressure_from_mmHg(head) *
                                        units::flow_from_l_per_min(point.flow_l_per_min));
    point.efficiency_percent = efficiency_percent(point);
    point.periodic = true;
    point.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    points.push_back(point);
    if (on_point) on_point();
  }
  return points;
}

std::vector<std::string> EmulatedLevel::remarks(const Scene& scene,
                                                std::span<const double> heads_mmHg) const {
  const auto point = emulator_point(scene.operating_point);
  const auto& drive = emulator_.inputs[1];
  return rom::outside_training_box(rom::training_box(emulator_), point[0], point[1], heads_mmHg,
                                   {drive.name.c_str(), drive.unit.c_str()});
}

Scene scene_of_emulator(const rom::Emulator& emulator, const std::string& file, double frequency_Hz,
                        const std::optional<double>& stroke_mm, const std::optional<double>& voltage_V) {
  const bool by_voltage = emulator.driven_by_voltage;
  const auto& drive = by_voltage ? voltage_V : stroke_mm;
  const auto& other = by_voltage ? stroke_mm : voltage_V;
  if (!drive || other)
    throw InputError(
        by_voltage ? "the emulator is of a pump driven by a voltage"
                   : "the emulator is of a pump driven by a stroke",
        !drive ? (by_voltage ? "no --voltage" : "no --stroke") : (by_voltage ? "--stroke" : "--voltage"),
        by_voltage ? "--voltage alone" : "--stroke alone", file);
  for (const auto& [name, value] : {std::pair("frequency (Hz)", frequency_Hz), std::pair("drive", *drive)})
    if (!std::isfinite(value) || value <= 0)
      throw InputError(std::string("no operating point: ") + name, plain_number(value), "a finite number > 0",
                       file);
  Scene scene;
  scene.name = std::filesystem::path(file).stem().string();
  auto& at = scene.operating_point;
  at.frequency = frequency_Hz;
  at.drive = by_voltage ? Drive::voltage : Drive::stroke;
  (by_voltage ? at.voltage : at.stroke) = by_voltage ? *drive : units::length_from_mm(*drive);
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
