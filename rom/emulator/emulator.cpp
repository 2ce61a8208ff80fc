#include "rom/emulator/emulator.hpp"

#include <cmath>

#include "rom/curve/error_estimate.hpp"

namespace undula::rom {

namespace {

double value_of(const Emulator& emulator, const EmulatorPoint& point, std::size_t input) {
  return input < point.size() ? point[input] : emulator.inputs[input].stated;
}

} // namespace

Eigen::VectorXd scaled_point(const Emulator& emulator, const EmulatorPoint& point) {
  Eigen::VectorXd scaled(static_cast<Eigen::Index>(emulator.inputs.size()));
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < emulator.inputs.size(); ++i) {
    const auto& input = emulator.inputs[i];
    if (input.high > input.low)
      scaled[count++] = (value_of(emulator, point, i) - input.low) / (input.high - input.low);
  }
  return scaled.head(count);
}

TrainingBox training_box(const Emulator& emulator) {
  const auto &frequency = emulator.inputs[0], &drive = emulator.inputs[1], &head = emulator.inputs[2];
  return {frequency.low, frequency.high, drive.low, drive.high, head.low, head.high};
}

std::span<const EmulatorInput> further_inputs(const Emulator& emulator) {
  return std::span(emulator.inputs).subspan(point_inputs);
}

double growth_at(const Emulator& emulator, const EmulatorPoint& point) {
  double off = 0;
  for (std::size_t i = 0; i < emulator.inputs.size(); ++i) {
    const auto& input = emulator.inputs[i];
    off = std::hypot(off, parts_outside(value_of(emulator, point, i), input.low, input.high));
  }
  return growth_outside(off);
}

EmulatedPoint emulate(const Emulator& emulator, const EmulatorPoint& point) {
  const Eigen::VectorXd x = scaled_point(emulator, point);
  const double growth = growth_at(emulator, point);
  EmulatedPoint result;
  result.inside_training_box = growth == 1;
  for (const auto& quantity : emulator.quantities) {
    const auto there = quantity.process(x);
    // What neighbouring runs do not share, a run between them need not share either.
    const double deviation = std::hypot(there.deviation, std::sqrt(quantity.process.parameters().nugget));
    result.values.push_back({there.mean, growth * quantity.error_factor * deviation});
  }
  return result;
}

} // namespace undula::rom
