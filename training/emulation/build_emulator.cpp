#include "training/emulation/build_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fom/levels/emulated_level.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/recorded_level.hpp"
#include "training/emulation/fit_process.hpp"
#include "training/emulation/quantile.hpp"

namespace undula::training {
namespace {

/// A run that counts.
struct KnownRun {
  rom::EmulatorRun run;
  CurvePoint point;
};

std::string point_text(const rom::Emulator& emulator, const rom::EmulatorPoint& point) {
  std::string text;
  for (std::size_t i = 0; i < point.size(); ++i)
    text += (i > 0 ? ", " : "") + plain_number(point[i]) + " " + emulator.inputs[i].unit;
  return text;
}

/// Nothing for runs that say no mean flow; `why` then tells.
std::optional<KnownRun> known_run(const rom::Emulator& emulator, const Scene& scene, const RunRecord& record,
                                  std::string& why) {
  KnownRun known;
  known.point = curve_point_of(scene, record);
  if (record.state == RunState::failed || !std::isfinite(known.point.flow_l_per_min)) {
    why = record.reason;
    return std::nullopt;
  }
  if (!known.point.periodic && !std::isfinite(known.point.standard_error_l_per_min)) {
    why = "it does not repeat, and too few periods tell its mean";
    return std::nullopt;
  }
  known.run.point = emulator_point(emulator, record.point);
  known.run.flow_l_per_min = known.point.flow_l_per_min;
  known.run.standard_error_l_per_min = known.point.periodic ? 0 : known.point.standard_error_l_per_min;
  if (const auto total = record.seconds.find("total"); total != record.seconds.end())
    known.run.seconds = total->second;
  return known;
}

EmulatorScore score_of(const std::vector<rom::EmulatorRun>& runs, bool held_out) {
  EmulatorScore score;
  std::vector<double> ratios;
  for (const auto& run : runs) {
    if (run.held_out != held_out) continue;
    const double error = std::abs(run.emulated_l_per_min - run.flow_l_per_min);
    ++score.runs;
    score.rms += error * error;
    score.worst = std::max(score.worst, error);
    score.covered += error <= run.stated_error_l_per_min;
    ratios.push_back(run.stated_error_l_per_min / std::max(error, 1e-12));
  }
  if (score.runs == 0) return score;
  score.rms = std::sqrt(score.rms / score.runs);
  score.covered /= score.runs;
  score.error_over_true = quantile(ratios, 0.5);
  return score;
}

std::vector<rom::EmulatorInput> inputs_of(const Scene& scene) {
  const auto& box = scene.training;
  const bool by_voltage = scene.operating_point.drive == Drive::voltage;
  std::vector<rom::EmulatorInput> inputs = {
      {"frequency", "Hz", box.frequency_low, box.frequency_high},
      by_voltage ? rom::EmulatorInput{"voltage", "V", box.voltage_low, box.voltage_high}
                 : rom::EmulatorInput{"stroke", "mm", units::length_to_mm(box.stroke_low),
                                      units::length_to_mm(box.stroke_high)},
      {"head", "mmHg", units::pressure_to_mmHg(box.head_low), units::pressure_to_mmHg(box.head_high)}};
  for (const auto& key : varied_keys(scene))
    inputs.push_back({key.key, key.unit, key.low, key.high, key.stated});
  return inputs;
}

} // namespace

BuiltEmulator build_emulator(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                             std::span<const rom::EmulatedColumn> columns) {
  BuiltEmulator built;
  auto& emulator = built.emulator;
  emulator.driven_by_voltage = scene.operating_point.drive == Drive::voltage;
  // Where the coil's resistance is stated, the force per volt changes the damping too.
  if (emulator.driven_by_voltage && scene.actuator.coil_resistance == 0)
    emulator.force_N_per_V = surface_value(scene, force_key);
  emulator.inputs = inputs_of(scene);
  std::vector<KnownRun> training, held_out;
  const auto collect = [&](const std::vector<OperatingPoint>& points, bool held) {
    for (const auto& at : points) {
      std::string why;
      auto known = known_run(emulator, scene, store.load(at, RecordParts::without_snapshots), why);
      if (known) {
        known->run.held_out = held;
        (held ? held_out : training).push_back(std::move(*known));
      } else {
        built.not_used.push_back(point_text(emulator, emulator_point(emulator, at)) + ": " + why);
      }
    }
  };
  collect(plan.training, false);
  collect(plan.held_out, true);

  const auto count = static_cast<Eigen::Index>(training.size());
  const Eigen::Index inputs = scaled_point(emulator, {}).size();
  if (inputs == 0 || count < inputs + 3)
    throw InputError(
        "too few runs for an emulator",
        std::to_string(count) + " that can be used, " + std::to_string(inputs) + " ranges with a width" +
            (built.not_used.empty() ? "" : "; the first of the others: " + built.not_used.front()),
        "a range with a width, and three runs more than there are such ranges",
        "section [training] of the scene");
  Eigen::MatrixXd points(inputs, count);
  for (Eigen::Index i = 0; i < count; ++i)
    points.col(i) = scaled_point(emulator, training[static_cast<std::size_t>(i)].run.point);
  for (const auto& column : columns) {
    const bool is_flow = emulator.quantities.empty();
    Eigen::VectorXd values(count), noise = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& known = training[static_cast<std::size_t>(i)];
      values[i] = known.point.*column.value;
      if (is_flow) noise[i] = known.run.standard_error_l_per_min;
    }
    if (!values.allFinite()) {
      if (values.array().isFinite().any())
        built.not_used.push_back(std::string(column.name) + ": not all runs know it");
      continue;
    }
    auto process = fit_process(points, values, noise);
    const auto left_out = process.leave_one_out();
    std::vector<double> parts;
    for (Eigen::Index i = 0; i < count; ++i)
      parts.push_back(std::abs(values[i] - left_out(i, 0)) / left_out(i, 1));
    constexpr double least = 1.645; // of a normal distribution: few runs can be met by luck
    const double factor = std::max(quantile(parts, nine_in_ten), least);
    if (is_flow)
      for (Eigen::Index i = 0; i < count; ++i) {
        auto& run = training[static_cast<std::size_t>(i)].run;
        run.emulated_l_per_min = left_out(i, 0);
        run.stated_error_l_per_min = factor * left_out(i, 1);
      }
    emulator.quantities.push_back({column.name, column.unit, std::move(process), factor});
  }
  for (auto& known : held_out) {
    const auto there = rom::emulate(emulator, known.run.point).values.front();
    known.run.emulated_l_per_min = there.value;
    // The run's own mean is off as well.
    known.run.stated_error_l_per_min = std::hypot(
        there.error, emulator.quantities.front().error_factor * known.run.standard_error_l_per_min);
  }
  double low = training.front().run.flow_l_per_min, high = low;
  for (const auto* runs : {&training, &held_out})
    for (const auto& known : *runs) {
      low = std::min(low, known.run.flow_l_per_min);
      high = std::max(high, known.run.flow_l_per_min);
      emulator.runs.push_back(known.run);
    }
  built.flow_range = high - low;
  built.left_out = score_of(emulator.runs, false);
  built.held_out = score_of(emulator.runs, true);
  return built;
}

} // namespace undula::training
