#include "fom/long_wave/hose_pressures.hpp"

#include <algorithm>

#include "geometry/hose/flattened_bore.hpp"

namespace undula::fom {

double HosePressures::at(double where) const {
  const auto right = std::ranges::lower_bound(position, where);
  if (right == position.begin()) return pressure.front();
  if (right == position.end()) return pressure.back();
  const auto i = static_cast<std::size_t>(right - position.begin());
  const double part = (where - position[i - 1]) / (position[i] - position[i - 1]);
  return pressure[i - 1] + part * (pressure[i] - pressure[i - 1]);
}

HosePressures hose_pressures(const HoseModel& model, const HoseInstant& instant, double head, double outflow,
                             double acceleration) {
  const double density = model.fluid.density, recovery = model.hose.throat_recovery;
  double flow = outflow, place_on_line = model.length;
  double pressure = outlet_static_pressure(model, head, outflow);
  HosePressures line{{model.length}, {pressure}};
  const auto add = [&](double position) {
    if (position >= line.position.back()) return; // no length between
    line.position.push_back(position);
    line.pressure.push_back(pressure);
  };
  const auto open_to = [&](double position) {
    const double gradient = open_friction_gradient(model, flow) + density * acceleration / model.area;
    pressure += gradient * (place_on_line - position);
    place_on_line = position;
    add(position);
  };
  for (auto place = instant.places.rbegin(); place != instant.places.rend(); ++place) {
    open_to(place->at.position + place->reach);
    const auto kinetic = [&](double added, double area) {
      const double relative = (flow + added) / area - place->at.speed;
      return 0.5 * density * relative * relative;
    };
    const bool backwards =
        flow + place->throat_added - place->at.speed * place->throat_area < 0; // relative to the roller
    const double right_part = backwards ? 1 : recovery, left_part = backwards ? recovery : 1;
    const double at_right = kinetic(0, model.area),
                 at_throat = kinetic(place->throat_added, place->throat_area);
    const double before = pressure; // at the right edge
    double gradual = 0;             // friction and acceleration so far
    for (auto sample = place->samples.rbegin(); sample != place->samples.rend(); ++sample) {
      const double here = flow + sample->added;
      const double step = sample->length * (friction_gradient(model.fluid, here, sample->area,
                                                              sample->conductance, sample->diameter) +
                                            density * acceleration / sample->area);
      const double now = kinetic(sample->added, sample->area);
      pressure = before + gradual + 0.5 * step +
                 (sample->offset > 0 ? right_part * (at_right - now)
                                     : right_part * (at_right - at_throat) + left_part * (at_throat - now));
      gradual += step;
      add(place->at.position + sample->offset);
    }
    place_on_line = place->at.position - place->reach;
    pressure = before + gradual + right_part * (at_right - at_throat) +
               left_part * (at_throat - kinetic(place->left_added, model.area));
    add(place_on_line);
    flow += place->left_added;
  }
  open_to(0);
  std::ranges::reverse(line.position);
  std::ranges::reverse(line.pressure);
  return line;
}

double largest_roller_force(const HoseModel& model, const HoseInstant& instant,
                            const HosePressures& pressures) {
  std::vector<double> forces(static_cast<std::size_t>(model.track.rollers), 0.0);
  for (const SqueezedPlace& place : instant.places)
    for (const PlaceSample& sample : place.samples)
      forces[static_cast<std::size_t>(place.at.roller)] +=
          sample.length * ((*model.ring)(sample.height + model.hose.wall).force +
                           pressures.at(place.at.position + sample.offset) *
                               geometry::flattened_width(model.track.bore_radius, sample.height));
  return *std::ranges::max_element(forces);
}

} // namespace undula::fom
