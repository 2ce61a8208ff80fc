#include "fom/long_wave/hose_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fom/scene/hose_checks.hpp"

namespace undula::fom {

using std::numbers::pi;

HoseModel hose_model(const Scene& scene) {
  HoseModel model;
  model.track = roller_track(scene);
  model.hose = scene.hose;
  model.fluid = scene.fluid;
  const double a = model.track.bore_radius, wall = scene.hose.wall;
  model.length = scene.hose.inlet_length +
                 geometry::centreline_radius(model.track) * model.track.track_angle +
                 scene.hose.outlet_length;
  model.area = pi * a * a;
  if (scene.hose.young > 0) {
    const double poisson = scene.hose.poisson;
    const double stiffness = scene.hose.young * wall * wall * wall / (12 * (1 - poisson * poisson));
    model.ring.emplace(a + wall / 2, stiffness);
  }
  return model;
}

double roller_angle(const HoseModel& model, double frequency, double time, int roller) {
  const double turns = frequency * time - static_cast<double>(roller) / model.track.rollers;
  return 2 * pi * (turns - std::floor(turns));
}

std::vector<PressedPlace> pressed_places(const HoseModel& model, double frequency, double time) {
  const geometry::RollerTrack& track = model.track;
  const double radius = geometry::centreline_radius(track), released = geometry::release_angle(track);
  const double rate = 2 * pi * frequency;
  std::vector<PressedPlace> places;
  for (int roller = 0; roller < track.rollers; ++roller) {
    // A roller may leave the track while, a turn behind, it enters it.
    for (double angle = roller_angle(model, frequency, time, roller) - 2 * pi;
         angle < track.track_angle + released; angle += 2 * pi) {
      const auto at = geometry::gap_at(track, angle);
      if (at.gap >= 2 * track.bore_radius) continue;
      places.push_back(
          {roller, model.hose.inlet_length + radius * angle, radius * rate, at.gap, at.slope * rate});
    }
  }
  std::ranges::sort(places, {}, &PressedPlace::position);
  return places;
}

double first_pressed(const HoseModel& model) {
  return model.hose.inlet_length - geometry::outer_reach(model.track);
}

double last_pressed(const HoseModel& model) {
  return model.length - model.hose.outlet_length + geometry::outer_reach(model.track);
}

} // namespace undula::fom
