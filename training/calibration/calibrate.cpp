#include "training/calibration/calibrate.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/calibration/scene_flows.hpp"
#include "training/calibration/uncertainty.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

constexpr std::array stated_by_data = {"operating_point.frequency_Hz", "operating_point.stroke_mm",
                                       "operating_point.voltage_V", "operating_point.head_mmHg"};

[[noreturn]] void refuse(const FreeKey& key, const std::string& what, const std::string& seen,
                         const std::string& allowed) {
  throw InputError("the free key \"" + key.key + "\" " + what, seen, allowed, "--free");
}

std::string range_text(const FreeKey& key) { return exact_number(key.low) + ":" + exact_number(key.high); }

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

double root_mean_square(const Eigen::VectorXd& values) {
  return values.norm() / std::sqrt(static_cast<double>(values.size()));
}

} // namespace

Eigen::VectorXd measured_flows(std::span<const TargetCurve> targets) {
  std::vector<double> all;
  for (const TargetCurve& target : targets)
    all.insert(all.end(), target.flow_l_per_min.begin(), target.flow_l_per_min.end());
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Eigen::VectorXd deviations(std::span<const TargetCurve> targets) {
  std::vector<double> all;
  for (const TargetCurve& target : targets)
    all.insert(all.end(), target.head_mmHg.size(),
               std::hypot(target.scatter_l_per_min, flow_noise_l_per_min));
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

void check_free_keys(const Scene& scene, std::span<const FreeKey> keys) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const FreeKey& key = keys[i];
    const double value = surface_value(scene, key.key); // refuses unknown keys
    if (std::ranges::find(stated_by_data, key.key) != stated_by_data.end())
      refuse(key, "is stated by the data", key.key, "keys that the data do not state");
    if (std::ranges::any_of(keys.first(i), [&](const FreeKey& other) { return other.key == key.key; }))
      refuse(key, "is given twice", key.key, "every key once");
    if (!(key.low < key.high)) refuse(key, "has no range", range_text(key), "low:high with low < high");
    with_value(scene, key.key, key.low); // refuse values out of the key's own range
    with_value(scene, key.key, key.high);
    if (value < key.low || value > key.high)
      refuse(key, "starts outside its range", exact_number(value) + " in the scene",
             "a value in " + range_text(key) + ", by --set or another range");
  }
}

Scene with_values(const Scene& scene, std::span<const FreeKey> keys, const Eigen::VectorXd& values) {
  Scene changed = scene;
  for (std::size_t i = 0; i < keys.size(); ++i)
    changed = with_value(changed, keys[i].key, values[static_cast<Eigen::Index>(i)]);
  return changed;
}

Eigen::VectorXd values_of(const Scene& scene, std::span<const FreeKey> keys) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(keys.size()));
  for (std::size_t i = 0; i < keys.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = surface_value(scene, keys[i].key);
  return values;
}

std::string setting_text(const TargetCurve& target) {
  return plain_number(target.frequency_Hz) + " Hz, " +
         (target.voltage_V > 0 ? plain_number(target.voltage_V) + " V"
                               : plain_number(target.stroke_mm) + " mm");
}

Scene at_setting(const Scene& scene, const TargetCurve& target) {
  const bool by_voltage = scene.operating_point.drive == Drive::voltage;
  return with_value(with_value(scene, stated_by_data[0], target.frequency_Hz),
                    stated_by_data[by_voltage ? 2 : 1], by_voltage ? target.voltage_V : target.stroke_mm);
}

std::vector<FreeKey> held_keys(const Scene& scene, std::span<const FreeKey> beside) {
  constexpr double reach = 3;
  std::vector<FreeKey> held;
  for (const auto& [key, tolerance] : scene.tolerances) {
    if (std::ranges::any_of(beside, [&key = key](const FreeKey& other) { return other.key == key; }))
      continue;
    const double value = surface_value(scene, key), deviation = tolerance / deviations_of_95_percent;
    // Where the key may not go that far, the tolerance itself ends within what is allowed.
    const auto end = [&, &name = key, &tolerance = tolerance](double sign) {
      const double far = value + sign * reach * deviation;
      try {
        with_value(scene, name, far);
        return far;
      } catch (const InputError&) {
        return value + sign * tolerance;
      }
    };
    held.push_back({key, end(-1), end(1), deviation, value});
  }
  return held;
}

FlowsOfValues flows_of_scene(const Scene& scene, std::span<const FreeKey> keys,
                             std::span<const TargetCurve> targets, MPI_Comm comm,
                             std::function<void(const std::string&)> on_failure, LevelOfScene level_of) {
  return [scene, keys, targets, comm, on_failure = std::move(on_failure),
          level_of = std::move(level_of)](const Eigen::VectorXd& values) -> std::optional<Eigen::VectorXd> {
    std::string reason;
    try {
      const Scene changed = with_values(scene, keys, values);
      PhaseTimer timer;
      const auto level = level_of ? level_of(changed) : prepare_level(changed, comm, timer);
      std::vector<double> all;
      for (const TargetCurve& target : targets) {
        const SceneFlows flows = scene_flows(*level, at_setting(changed, target), target.head_mmHg, comm);
        all.insert(all.end(), flows.flow_l_per_min.begin(), flows.flow_l_per_min.end());
        // The numbers decide, as they are the same on every rank.
        if (std::ranges::all_of(flows.flow_l_per_min, [](double flow) { return std::isfinite(flow); }))
          continue;
        if (on_failure) on_failure(flows.failure);
        return std::nullopt;
      }
      return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
    } catch (const InputError& error) { // a geometry, say, that these values make impossible
      reason = error.what();
    } catch (const NumericsError& error) {
      reason = error.what();
    }
    if (on_failure) on_failure(reason);
    return std::nullopt;
  };
}

Calibration calibrate(const FlowsOfValues& flows, std::span<const FreeKey> keys, const Eigen::VectorXd& start,
                      std::span<const TargetCurve> targets, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Eigen::VectorXd measured = measured_flows(targets), deviation = deviations(targets);
  const bool held = std::ranges::any_of(keys, [](const FreeKey& key) { return key.prior_deviation > 0; });
  const auto size = static_cast<Eigen::Index>(keys.size());
  Eigen::VectorXd low(size), high(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    low[i] = keys[static_cast<std::size_t>(i)].low;
    high[i] = keys[static_cast<std::size_t>(i)].high;
  }
  Eigen::VectorXd start_flows;
  const Residuals residuals = [&](const Eigen::VectorXd& values) -> std::optional<Eigen::VectorXd> {
    auto computed = flows(values);
    if (!computed) return std::nullopt;
    if (start_flows.size() == 0) start_flows = *computed; // the start comes first
    Eigen::VectorXd all = *computed - measured;
    if (!held) return all;
    all = all.cwiseQuotient(deviation);
    for (Eigen::Index i = 0; i < size; ++i) {
      const FreeKey& key = keys[static_cast<std::size_t>(i)];
      if (key.prior_deviation <= 0) continue;
      all.conservativeResize(all.size() + 1);
      all[all.size() - 1] = (values[i] - key.prior_value) / key.prior_deviation;
    }
    return all;
  };
  FitOptions steps = options;
  steps.search = options.search && !held; // the tolerances leave no valley to search
  BoundedFit fit = fit_within_bounds(residuals, low, high, start, steps);
  const double misfit =
      held ? fit.residuals.squaredNorm() : fit.residuals.cwiseQuotient(deviation).squaredNorm();
  if (held) { // of the flows alone, l/min
    fit.residuals = fit.residuals.head(measured.size()).cwiseProduct(deviation).eval();
    fit.jacobian = (deviation.asDiagonal() * fit.jacobian.topRows(measured.size())).eval();
  }

  Calibration result;
  result.start = start;
  result.optimum = fit.point;
  for (Eigen::Index i = 0; i < size; ++i)
    result.at_bound.push_back(std::min(fit.point[i] - low[i], high[i] - fit.point[i]) <=
                              options.least_step * (high[i] - low[i]));
  Eigen::Index first = 0;
  for (const TargetCurve& target : targets) {
    const auto heads = static_cast<Eigen::Index>(target.head_mmHg.size());
    const Eigen::VectorXd before = start_flows.segment(first, heads);
    const Eigen::VectorXd after = fit.residuals.segment(first, heads) + measured.segment(first, heads);
    result.curves.push_back({{before.begin(), before.end()},
                             {after.begin(), after.end()},
                             root_mean_square(before - measured.segment(first, heads)),
                             root_mean_square(fit.residuals.segment(first, heads)),
                             fit.jacobian.middleRows(first, heads)});
    first += heads;
  }
  result.misfit = misfit;
  result.identified =
      identifiability(fit.jacobian, high - low, deviation, flow_noise_l_per_min / options.difference_step);
  result.converged = fit.converged;
  result.points = fit.points;
  result.refused = fit.refused;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::vector<std::string> identifiability_statements(std::span<const FreeKey> keys,
                                                    const Identifiability& identified) {
  const auto name = [&](int i) { return keys[static_cast<std::size_t>(i)].key; };
  std::vector<std::string> statements;
  for (const int i : identified.without_influence)
    statements.push_back(name(i) + " has no influence: its range changes the flow by " +
                         rounded(identified.influence[i]) + " l/min, no more than noise");
  for (const auto& [a, b] : identified.correlated)
    statements.push_back(name(a) + " and " + name(b) + " cannot be told apart: correlation " +
                         exact_number(std::round(1e4 * identified.correlation(a, b)) / 1e4) +
                         "; the data fix a combination of them");
  for (const int i : identified.unfixed_directions) {
    const Eigen::VectorXd direction = identified.directions.col(i);
    std::string text;
    for (Eigen::Index j = 0; j < direction.size(); ++j) {
      constexpr double small_part = 0.1;
      if (std::abs(direction[j]) < small_part) continue;
      text += (text.empty() ? (direction[j] < 0 ? "-" : "") : (direction[j] < 0 ? " - " : " + ")) +
              rounded(std::abs(direction[j])) + " " + name(static_cast<int>(j));
    }
    const double error = identified.direction_error[i];
    statements.push_back("the data do not fix the direction " + text + " (in parts of the ranges): " +
                         (std::isfinite(error) ? "standard error " + rounded(error) + " of the range, "
                                               : "no influence at all, ") +
                         "not better than the range itself");
  }
  return statements;
}

} // namespace undula::training
