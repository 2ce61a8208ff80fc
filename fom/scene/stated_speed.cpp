#include "fom/scene/stated_speed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "fom/scene/expression.hpp"
#include "fom/scene/fluid_size.hpp"
#include "fom/scene/scene_time.hpp"
#include "fom/scene/shape_outline.hpp"
#include "geometry/mesh/box_grid.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

using Places = std::vector<Point<2>>;

constexpr int sampled_instants = 64;
constexpr int places_per_edge = 8; ///< even: the middle of a parabola is among them
constexpr int places_across = 16;  ///< of a body, in each direction
constexpr std::size_t most_places =
    4000; ///< of a function, evenly chosen: a fine circle has a hundred thousand

/// From 0 to `end`, spread by the golden ratio.
std::vector<double> sampled_times(double end) {
  std::vector<double> times = {0, end};
  for (int k = 1; k < sampled_instants; ++k) {
    const double turns = k / std::numbers::phi;
    times.push_back(end * (turns - std::floor(turns)));
  }
  return times;
}

/// Functions of a scene that may be undefined somewhere.
class Sampler {
public:
  explicit Sampler(const Scene& scene) : scene_(scene), times_(sampled_times(scene.time.end)) {}

  std::optional<Expression> function(const std::string& text) const {
    if (text.empty()) return {};
    return Expression(text, scene_.space, scene_.problem.constants, "an expression");
  }
  /// Value at a place (cm) and time, 0 where it is not finite.
  static double value(const std::optional<Expression>& function, const Point<2>& x, double t) {
    if (!function) return 0;
    return function->finite_value(units::length_to_mm(x[0]), units::length_to_mm(x[1]), t).value_or(0);
  }
  /// Greatest length of a vector with two functions as components.
  double greatest(const std::array<std::string, 2>& texts, const Places& places) const {
    return greatest(texts, places, times_);
  }
  double greatest(const std::array<std::string, 2>& texts, const Places& places,
                  const std::vector<double>& times) const {
    return greatest_length(texts, places, times, value);
  }
  /// The same of its change over a time step, per second.
  double greatest_rate(const std::array<std::string, 2>& texts, const Places& places) const {
    const double step = time_step(scene_);
    const auto rate = [step](const std::optional<Expression>& function, const Point<2>& x, double t) {
      const double before = std::max(t - step, 0.0); // no motion is stated before the start
      return (value(function, x, before + step) - value(function, x, before)) / step;
    };
    return greatest_length(texts, places, times_, rate);
  }
  const std::vector<double>& times() const { return times_; }

private:
  template <class Component>
  double greatest_length(const std::array<std::string, 2>& texts, const Places& places,
                         const std::vector<double>& times, const Component& component) const {
    const auto first = function(texts[0]), second = function(texts[1]);
    double length = 0;
    if (!first) return length;
    const std::size_t stride = 1 + places.size() / most_places;
    for (const double t : times)
      for (std::size_t i = 0; i < places.size(); i += stride)
        length =
            std::max(length, std::hypot(component(first, places[i], t), component(second, places[i], t)));
    return length;
  }

  const Scene& scene_;
  std::vector<double> times_;
};

void add_edge(Places& places, const Point<2>& from, const Point<2>& to) {
  for (int i = 0; i <= places_per_edge; ++i) places.push_back(from + (to - from) * i / places_per_edge);
}

/// Places along the boundary `name` of the domain or of a hole.
Places places_along(const TaggedPolygon& domain, const std::string& name) {
  Places places;
  const auto named = [&](int tag) { return domain.names[static_cast<std::size_t>(tag)] == name; };
  const auto count = domain.points.size();
  for (std::size_t i = 0; i < count; ++i)
    if (named(domain.tags[i])) add_edge(places, domain.points[i], domain.points[(i + 1) % count]);
  for (const auto& hole : domain.holes)
    if (named(hole.tag)) places.insert(places.end(), hole.points.begin(), hole.points.end());
  return places;
}

double diameter(const Box<2>& box) { return (box.high - box.low).norm(); }

/// A grid over the box of a body, its corners among the places; only what is held where `held` says.
Places places_in(const Box<2>& box, const std::optional<Expression>& held) {
  Places places;
  for (int i = 0; i <= places_across; ++i)
    for (int j = 0; j <= places_across; ++j) {
      const Point<2> part(static_cast<double>(i) / places_across, static_cast<double>(j) / places_across);
      const Point<2> x = box.low + part.cwiseProduct(box.high - box.low);
      if (!held || Sampler::value(held, x, 0) != 0) places.push_back(x);
    }
  return places;
}

/// Greatest difference of pressure between openings at a time, from 0 where there is but one, dyn/cm^2.
double opening_difference(const ProblemStatement& problem, const Sampler& sampler) {
  std::vector<std::optional<Expression>> pressures;
  for (const auto& [name, boundary] : problem.boundaries)
    if (boundary.kind == BoundaryStatement::Kind::opening)
      pressures.push_back(sampler.function(boundary.pressure));
  double difference = 0;
  if (pressures.empty()) return difference;
  for (const double t : sampler.times()) {
    std::vector<double> values;
    for (const auto& pressure : pressures)
      values.push_back(units::dyn_per_cm2_per_mmHg * Sampler::value(pressure, Point<2>::Zero(), t));
    if (values.size() == 1) values.push_back(0);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    difference = std::max(difference, *high - *low);
  }
  return difference;
}

double two_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1e", value);
  return std::strtod(text.data(), nullptr);
}

} // namespace

double stated_speed(const Scene& scene) {
  const ProblemStatement& problem = scene.problem;
  if (!problem.general || !has_fluid(problem.domain)) return 0;
  const bool axisymmetric = scene.space == Space::axisymmetric;
  const Sampler sampler(scene);
  const TaggedPolygon domain = domain_polygon(problem);
  const double length = diameter(box_around<2>(domain.points));

  double speed = 0, pressure = opening_difference(problem, sampler), push = 0;
  for (const auto& [name, boundary] : problem.boundaries)
    if (boundary.kind == BoundaryStatement::Kind::velocity)
      speed = std::max(speed, sampler.greatest(boundary.velocity, places_along(domain, name)));
  pressure = std::max(pressure, length * sampler.greatest(problem.body_force, domain.points));
  for (const auto& [name, body] : problem.bodies) {
    const Box<2> box = box_around<2>(body_corners(body, axisymmetric));
    const Places inside = places_in(box, {});
    speed = std::max(speed, sampler.greatest(body.velocity, inside, {0.0}));
    const auto held = sampler.function(body.held);
    if (held)
      speed =
          std::max(speed, units::cm_per_mm * sampler.greatest_rate(body.displacement, places_in(box, held)));
    push = std::max(push, diameter(box) * sampler.greatest(body.body_force, inside));
  }
  const auto driven_by = [&](double difference) {
    return std::min(std::sqrt(2 * difference / scene.fluid.density),
                    difference * length / (8 * scene.fluid.viscosity));
  };
  speed = std::max(speed, driven_by(pressure));
  // A stiff body takes most of a force itself.
  return two_digits(speed > 0 ? speed : driven_by(push));
}

} // namespace undula::fom
