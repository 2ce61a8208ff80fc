#include "fom/long_wave/squeezed_place.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "fom/long_wave/hose_friction.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Integral of the flat width from an offset to the right edge: the height is gap + offset^2 / (2 r).
double width_to_the_right(double a, double gap, double r, double offset, double reach) {
  const auto primitive = [&](double s) { return pi * ((a - gap / 2) * s - s * s * s / (12 * r)); };
  return primitive(reach) - primitive(offset);
}

} // namespace

double place_height(const HoseModel& model, const PressedPlace& at, double offset) {
  return std::min(at.gap + offset * offset / (2 * geometry::relative_radius(model.track)),
                  2 * model.track.bore_radius);
}

double added_flow(const HoseModel& model, const PressedPlace& at, double offset) {
  const double a = model.track.bore_radius;
  const double moved = at.speed * (geometry::flattened_area(a, place_height(model, at, offset)) - model.area);
  return moved + at.closing * width_to_the_right(a, at.gap, geometry::relative_radius(model.track), offset,
                                                 geometry::half_reach(model.track, at.gap));
}

SqueezedPlace squeezed_place(const HoseModel& model, const PressedPlace& at) {
  constexpr int panels = 24;
  static const double inner = std::sqrt(0.6);
  const std::array<double, 3> nodes = {-inner, 0, inner}, weights = {5.0 / 18, 8.0 / 18, 5.0 / 18};

  const double a = model.track.bore_radius, r = geometry::relative_radius(model.track);
  SqueezedPlace place{at, geometry::half_reach(model.track, at.gap), {}, 0, 0, 0};
  const double scale = std::sqrt(2 * r * at.gap), end = std::asinh(place.reach / scale);
  const double panel = 2 * end / panels;
  for (int i = 0; i < panels; ++i)
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double x = -end + panel * (i + 0.5 + 0.5 * nodes[k]);
      PlaceSample sample;
      sample.offset = scale * std::sinh(x);
      sample.length = scale * std::cosh(x) * panel * weights[k];
      sample.height = place_height(model, at, sample.offset);
      sample.area = geometry::flattened_area(a, sample.height);
      sample.conductance = flattened_conductance(a, sample.height);
      sample.diameter = geometry::flattened_hydraulic_diameter(a, sample.height);
      sample.added = added_flow(model, at, sample.offset);
      place.samples.push_back(sample);
    }
  place.throat_area = geometry::flattened_area(a, at.gap);
  place.throat_added = added_flow(model, at, 0);
  place.left_added = added_flow(model, at, -place.reach);
  return place;
}

} // namespace undula::fom
