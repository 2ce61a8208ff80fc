#include "training/emulation/next_points.hpp"

#include <algorithm>
#include <utility>

#include "fom/levels/emulated_level.hpp"
#include "training/campaign/run_record_file.hpp"

namespace undula::training {
namespace {

/// The same process with one more value, the one it expects.
rom::GaussianProcess believing(const rom::GaussianProcess& process, const Eigen::VectorXd& x) {
  const Eigen::Index count = process.points().cols();
  Eigen::MatrixXd points(x.size(), count + 1);
  points << process.points(), x;
  Eigen::VectorXd values(count + 1), noise(count + 1);
  values << process.values(), process(x).mean;
  noise << process.noise(), 0.0;
  return {std::move(points), std::move(values), std::move(noise), process.parameters()};
}

} // namespace

NextPoints next_points(const rom::Emulator& emulator, const Scene& scene,
                       std::span<const OperatingPoint> asked, int count) {
  NextPoints next;
  auto candidates = candidate_points(scene.training, scene.operating_point, varied_keys(scene));
  std::erase_if(candidates, [&](const OperatingPoint& at) {
    return std::ranges::any_of(asked, [&](const OperatingPoint& other) { return same_point(at, other); });
  });
  rom::Emulator now = emulator;
  now.quantities.erase(now.quantities.begin() + 1, now.quantities.end()); // the mean flow alone
  for (int k = 0; k < count; ++k) {
    const OperatingPoint* worst = nullptr;
    double largest = 0;
    for (const auto& at : candidates) {
      const double error = rom::emulate(now, emulator_point(emulator, at)).values.front().error;
      if (error <= largest || std::ranges::any_of(next.points, [&](const OperatingPoint& other) {
            return same_point(at, other);
          }))
        continue;
      largest = error;
      worst = &at;
    }
    if (!worst) break;
    if (k == 0) next.largest_error = largest;
    next.points.push_back(*worst);
    auto& flow = now.quantities.front();
    flow.process = believing(flow.process, scaled_point(now, emulator_point(emulator, *worst)));
  }
  return next;
}

} // namespace undula::training
