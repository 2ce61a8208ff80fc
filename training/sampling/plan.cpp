#include "training/sampling/plan.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/sampling/scrambled_halton.hpp"

namespace undula::training {
namespace {

constexpr int ranges = 3;
using UnitPoint = std::array<double, ranges>; // fixed ranges stay at 0

constexpr int candidates = 4096;
constexpr double margin = 0.1; // held-out points keep off the faces: judged is interpolation

/// Points of the training box in the unit cube.
class UnitHalton {
public:
  explicit UnitHalton(std::uint32_t seed) : sequence_(seed, ranges) {}
  UnitPoint operator()(int index) const {
    const auto point = sequence_(index);
    return {point[0], point[1], point[2]};
  }

private:
  ScrambledHalton sequence_;
};

double squared_distance(const UnitPoint& a, const UnitPoint& b) {
  double sum = 0;
  for (int i = 0; i < ranges; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

struct Box {
  UnitPoint low{}, high{}; // Hz, cm or V, dyn/cm^2
  OperatingPoint like;
  bool has_width(int i) const { return high[i] > low[i]; }

  UnitPoint without_fixed(UnitPoint point) const {
    for (int i = 0; i < ranges; ++i)
      if (!has_width(i)) point[i] = 0;
    return point;
  }
  OperatingPoint operator()(const UnitPoint& point) const {
    UnitPoint x;
    // Corners must be the bounds to the last bit.
    for (int i = 0; i < ranges; ++i)
      x[i] = point[i] == 1 ? high[i] : std::min(high[i], low[i] + point[i] * (high[i] - low[i]));
    OperatingPoint result = like;
    result.frequency = x[0];
    (like.drive == Drive::voltage ? result.voltage : result.stroke) = x[1];
    result.head = x[2];
    return result;
  }
};

void check_range(const char* name, double low, double high, const char* unit) {
  if (low <= high) return;
  throw InputError(std::string("the training box is empty in ") + name,
                   std::to_string(low) + " to " + std::to_string(high) + " " + unit, "low <= high",
                   "section [training] of the scene");
}

Box checked_box(const TrainingPlan& plan, const OperatingPoint& like) {
  const bool by_voltage = like.drive == Drive::voltage;
  check_range("frequency", plan.frequency_low, plan.frequency_high, "Hz");
  if (by_voltage)
    check_range("voltage", plan.voltage_low, plan.voltage_high, "V");
  else
    check_range("stroke", units::length_to_mm(plan.stroke_low), units::length_to_mm(plan.stroke_high), "mm");
  check_range("head", units::pressure_to_mmHg(plan.head_low), units::pressure_to_mmHg(plan.head_high),
              "mmHg");
  const Box box{{plan.frequency_low, by_voltage ? plan.voltage_low : plan.stroke_low, plan.head_low},
                {plan.frequency_high, by_voltage ? plan.voltage_high : plan.stroke_high, plan.head_high},
                like};
  const bool any_width = box.has_width(0) || box.has_width(1) || box.has_width(2);
  if (plan.training_points < 0 || plan.held_out_points < 0 ||
      (!any_width && plan.training_points + plan.held_out_points > 0))
    throw InputError("the counts of training and held-out points do not fit the box",
                     std::to_string(plan.training_points) + " and " + std::to_string(plan.held_out_points),
                     any_width ? "counts >= 0" : "0 and 0 in a box that is a single point",
                     "section [training] of the scene");
  return box;
}

std::vector<UnitPoint> corners(const Box& box) {
  std::vector<UnitPoint> points{UnitPoint{}};
  for (int i = 0; i < ranges; ++i) {
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
  const UnitHalton halton(20241);
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

bool is_inside(const TrainingPlan& plan, const OperatingPoint& point) {
  const Box box = checked_box(plan, point);
  const double drive = point.drive == Drive::voltage ? point.voltage : point.stroke;
  const UnitPoint x{point.frequency, drive, point.head};
  for (int i = 0; i < ranges; ++i)
    if (x[i] < box.low[i] || x[i] > box.high[i]) return false;
  return true;
}

std::vector<OperatingPoint> candidate_points(const TrainingPlan& plan, const OperatingPoint& like) {
  const Box box = checked_box(plan, like);
  const UnitHalton halton(4107);
  std::vector<UnitPoint> points;
  for (int k = 1; k <= candidates; ++k) points.push_back(box.without_fixed(halton(k)));
  return in_units(box, points);
}

SamplingPlan plan_samples(const TrainingPlan& plan, const OperatingPoint& like) {
  const Box box = checked_box(plan, like);
  auto training = corners(box);
  const UnitHalton halton(7);
  for (int k = 1; k <= plan.training_points; ++k) training.push_back(box.without_fixed(halton(k)));
  const auto held_out = farthest_points(box, training, plan.held_out_points);
  return {in_units(box, training), in_units(box, held_out)};
}

} // namespace undula::training
