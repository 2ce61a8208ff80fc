#include "training/sampling/plan.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/sampling/scrambled_halton.hpp"

namespace undula::training {
namespace {

constexpr std::size_t point_ranges = 3; // frequency, drive, head; those of varied keys come after them
using UnitPoint = std::vector<double>;  // fixed ranges stay at 0

constexpr int candidates = 4096;
constexpr double margin = 0.1; // held-out points keep off the faces: judged is interpolation

double squared_distance(const UnitPoint& a, const UnitPoint& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

struct Box {
  UnitPoint low, high; // Hz, cm or V, dyn/cm^2, units of the keys
  OperatingPoint like;
  std::span<const VariedKey> varied;
  std::size_t ranges() const { return low.size(); }
  bool has_width(std::size_t i) const { return high[i] > low[i]; }
  ScrambledHalton halton(std::uint32_t seed) const { return {seed, static_cast<int>(ranges())}; }

  UnitPoint without_fixed(UnitPoint point) const {
    for (std::size_t i = 0; i < ranges(); ++i)
      if (!has_width(i)) point[i] = 0;
    return point;
  }
  OperatingPoint operator()(const UnitPoint& point) const {
    UnitPoint x(ranges());
    // Corners must be the bounds to the last bit.
    for (std::size_t i = 0; i < ranges(); ++i)
      x[i] = point[i] == 1 ? high[i] : std::min(high[i], low[i] + point[i] * (high[i] - low[i]));
    OperatingPoint result = like;
    result.frequency = x[0];
    (like.drive == Drive::voltage ? result.voltage : result.stroke) = x[1];
    result.head = x[2];
    for (std::size_t k = 0; k < varied.size(); ++k) result.varied[varied[k].key] = x[point_ranges + k];
    return result;
  }
};

void check_range(const char* name, double low, double high, const char* unit) {
  if (low <= high) return;
  throw InputError(std::string("the training box is empty in ") + name,
                   std::to_string(low) + " to " + std::to_string(high) + " " + unit, "low <= high",
                   "section [training] of the scene");
}

Box checked_box(const TrainingPlan& plan, const OperatingPoint& like, std::span<const VariedKey> varied) {
  const bool by_voltage = like.drive == Drive::voltage;
  check_range("frequency", plan.frequency_low, plan.frequency_high, "Hz");
  if (by_voltage)
    check_range("voltage", plan.voltage_low, plan.voltage_high, "V");
  else
    check_range("stroke", units::length_to_mm(plan.stroke_low), units::length_to_mm(plan.stroke_high), "mm");
  check_range("head", units::pressure_to_mmHg(plan.head_low), units::pressure_to_mmHg(plan.head_high),
              "mmHg");
  Box box{{plan.frequency_low, by_voltage ? plan.voltage_low : plan.stroke_low, plan.head_low},
          {plan.frequency_high, by_voltage ? plan.voltage_high : plan.stroke_high, plan.head_high},
          like,
          varied};
  for (const auto& key : varied) {
    box.low.push_back(key.low);
    box.high.push_back(key.high);
  }
  bool any_width = false;
  for (std::size_t i = 0; i < box.ranges(); ++i) any_width = any_width || box.has_width(i);
  if (plan.training_points < 0 || plan.held_out_points < 0 ||
      (!any_width && plan.training_points + plan.held_out_points > 0))
    throw InputError("the counts of training and held-out points do not fit the box",
                     std::to_string(plan.training_points) + " and " + std::to_string(plan.held_out_points),
                     any_width ? "counts >= 0" : "0 and 0 in a box that is a single point",
                     "section [training] of the scene");
  return box;
}

/// Of the operating points. Their varied keys are left as stated: `training_points` of them are not.
std::vector<UnitPoint> corners(const Box& box) {
  std::vector<UnitPoint> points{UnitPoint(box.ranges(), 0.0)};
  for (std::size_t k = 0; k < box.varied.size(); ++k) {
    const auto& key = box.varied[k];
    points.front()[point_ranges + k] = (key.stated - key.low) / (key.high - key.low);
  }
  for (std::size_t i = 0; i < point_ranges; ++i) {
    if (!box.has_width(i)) continue;
    const auto count = points.size();
    for (std::size_t k = 0; k < count; ++k) {
      points.push_back(points[k]);
      points.back()[i] = 1;
    }
  }
  return points;
}

/// `count` points in the middle of the unit cube, each the farthest from all `taken` and from those before
/// it.
std::vector<UnitPoint> farthest_points(const Box& box, const std::vector<UnitPoint>& taken, int count) {
  const auto halton = box.halton(20241);
  std::vector<UnitPoint> pool;
  std::vector<double> clearance;
  for (int k = 1; k <= candidates; ++k) {
    auto point = halton(k);
    for (double& x : point) x = margin + (1 - 2 * margin) * x;
    pool.push_back(box.without_fixed(point));
    double nearest = std::numeric_limits<double>::max();
    for (const auto& other : taken) nearest = std::min(nearest, squared_distance(pool.back(), other));
    clearance.push_back(nearest);
  }
  std::vector<UnitPoint> chosen;
  for (int k = 0; k < count; ++k) {
    const auto best = std::max_element(clearance.begin(), clearance.end()) - clearance.begin();
    chosen.push_back(pool[best]);
    for (std::size_t i = 0; i < pool.size(); ++i)
      clearance[i] = std::min(clearance[i], squared_distance(pool[i], chosen.back()));
  }
  return chosen;
}

std::vector<OperatingPoint> in_units(const Box& box, const std::vector<UnitPoint>& points) {
  std::vector<OperatingPoint> result;
  std::transform(points.begin(), points.end(), std::back_inserter(result), box);
  return result;
}

} // namespace

bool is_inside(const TrainingPlan& plan, const OperatingPoint& point, std::span<const VariedKey> varied) {
  const Box box = checked_box(plan, point, varied);
  const double drive = point.drive == Drive::voltage ? point.voltage : point.stroke;
  UnitPoint x{point.frequency, drive, point.head};
  std::size_t known = 0;
  for (const auto& key : varied) {
    const auto there = point.varied.find(key.key);
    known += there != point.varied.end();
    x.push_back(there != point.varied.end() ? there->second : key.stated);
  }
  for (std::size_t i = 0; i < box.ranges(); ++i)
    if (x[i] < box.low[i] || x[i] > box.high[i]) return false;
  return known == point.varied.size();
}

std::vector<OperatingPoint> candidate_points(const TrainingPlan& plan, const OperatingPoint& like,
                                             std::span<const VariedKey> varied) {
  const Box box = checked_box(plan, like, varied);
  const auto halton = box.halton(4107);
  std::vector<UnitPoint> points;
  for (int k = 1; k <= candidates; ++k) points.push_back(box.without_fixed(halton(k)));
  return in_units(box, points);
}

SamplingPlan plan_samples(const TrainingPlan& plan, const OperatingPoint& like,
                          std::span<const VariedKey> varied) {
  const Box box = checked_box(plan, like, varied);
  auto training = corners(box);
  const auto corner_count = training.size();
  const auto halton = box.halton(7);
  for (int k = 1; k <= plan.training_points; ++k) training.push_back(box.without_fixed(halton(k)));
  const auto held_out = farthest_points(box, training, plan.held_out_points);
  SamplingPlan samples{in_units(box, training), in_units(box, held_out)};
  // The record of a corner is that of a campaign without varied keys.
  for (std::size_t k = 0; k < corner_count; ++k) samples.training[k].varied.clear();
  return samples;
}

} // namespace undula::training
