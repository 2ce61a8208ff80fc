#include "rom/emulator/emulator.hpp"

#include <cmath>

#include "rom/curve/error_estimate.hpp"

namespace undula::rom {

Eigen::VectorXd scaled_point(const Emulator& emulator, const EmulatorPoint& point) {
  Eigen::VectorXd scaled(emulator_inputs);
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const auto& input = emulator.inputs[i];
    if (input.high > input.low) scaled[count++] = (point[i] - input.low) / (input.high - input.low);
  }
  return scaled.head(count);
}

TrainingBox training_box(const Emulator& emulator) {
  const auto& [frequency, drive, head] = emulator.inputs;
  return {frequency.low, frequency.high, drive.low, drive.high, head.low, head.high};
}

EmulatedPoint emulate(const Emulator& emulator, const EmulatorPoint& point) {
  const Eigen::VectorXd x = scaled_point(emulator, point);
  const double growth = growth_outside_box(training_box(emulator), point[0], point[1], point[2]);
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
