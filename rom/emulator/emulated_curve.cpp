#include "rom/emulator/emulated_curve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/hq_curve.hpp"
#include "rom/emulator/emulated_quantities.hpp"

namespace undula::rom {
namespace {

void check_point(const Emulator& emulator, double frequency_Hz, double drive,
                 std::span<const double> heads_mmHg) {
  const auto refuse = [](const std::string& what, double seen, const char* allowed) {
    throw InputError("no operating point: " + what, plain_number(seen), allowed,
                     "operating point of the emulator");
  };
  for (const auto& [name, value] :
       {std::pair("frequency (Hz)", frequency_Hz), std::pair(emulator.inputs[1].name.c_str(), drive)})
    if (!std::isfinite(value) || value <= 0) refuse(name, value, "a finite number > 0");
  for (const double head : heads_mmHg)
    if (!std::isfinite(head)) refuse("head (mmHg)", head, "a finite number");
}

CurvePoint point_of(const Emulator& emulator, const EmulatorPoint& at) {
  const auto answer = emulate(emulator, at);
  CurvePoint point;
  point.head_mmHg = at[2];
  for (std::size_t q = 0; q < answer.values.size(); ++q)
    for (const auto& column : emulated_columns)
      if (emulator.quantities[q].name == column.name) point.*column.value = answer.values[q].value;
  point.inflow_l_per_min = point.flow_l_per_min;
  point.error_l_per_min = answer.values.front().error;
  point.inside_training_box = answer.inside_training_box;
  point.power_mW = units::power_to_mW(units::pressure_from_mmHg(point.head_mmHg) *
                                      units::flow_from_l_per_min(point.flow_l_per_min));
  point.efficiency_percent = efficiency_percent(point);
  point.periodic = true;
  return point;
}

} // namespace

std::vector<CurvePoint> emulated_curve(const Emulator& emulator, double frequency_Hz, double drive,
                                       std::span<const double> heads_mmHg,
                                       const std::function<void()>& on_point,
                                       std::span<const double> further) {
  check_point(emulator, frequency_Hz, drive, heads_mmHg);
  std::vector<CurvePoint> points;
  EmulatorPoint at{frequency_Hz, drive, 0};
  at.insert(at.end(), further.begin(), further.end());
  for (const double head : heads_mmHg) {
    const auto begin = std::chrono::steady_clock::now();
    at[2] = head;
    points.push_back(point_of(emulator, at));
    points.back().seconds["total"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (on_point) on_point();
  }
  return points;
}

std::vector<std::string> outside_training_box(const Emulator& emulator, double frequency_Hz, double drive,
                                              std::span<const double> heads_mmHg,
                                              std::span<const double> further) {
  const auto& input = emulator.inputs[1];
  auto lines = outside_training_box(training_box(emulator), frequency_Hz, drive, heads_mmHg,
                                    {input.name.c_str(), input.unit.c_str()});
  const auto others = further_inputs(emulator);
  for (std::size_t i = 0; i < std::min(further.size(), others.size()); ++i)
    tell_outside(others[i].name, others[i].unit, further[i], others[i].low, others[i].high, lines);
  return lines;
}

} // namespace undula::rom
