#include "geometry/hose/roller_track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace undula::geometry {
namespace {

double open_area(const RollerTrack& track) {
  return std::numbers::pi * track.bore_radius * track.bore_radius;
}

} // namespace

double centreline_radius(const RollerTrack& track) {
  return track.track_radius - track.wall - track.bore_radius;
}

double pressing_radius(const RollerTrack& track) { return track.track_radius - 2 * track.wall - track.gap; }

double crank(const RollerTrack& track) { return pressing_radius(track) - track.roller_radius; }

double relative_radius(const RollerTrack& track) {
  return 1 / (1 / track.roller_radius - 1 / pressing_radius(track));
}

double half_reach(const RollerTrack& track, double gap) {
  return std::sqrt(2 * relative_radius(track) * std::max(2 * track.bore_radius - gap, 0.0));
}

double missing_volume(const RollerTrack& track, double gap) {
  const double closed = std::max(1 - gap / (2 * track.bore_radius), 0.0);
  return 16.0 / 15 * open_area(track) * closed * closed * half_reach(track, gap);
}

GapAtAngle gap_at(const RollerTrack& track, double angle) {
  const double beyond = angle < 0 ? angle : std::max(angle - track.track_angle, 0.0);
  const double lifted = track.gap + crank(track) * (1 - std::cos(beyond));
  if (std::abs(beyond) >= std::numbers::pi / 2 || lifted >= 2 * track.bore_radius)
    return {2 * track.bore_radius, 0};
  return {lifted, crank(track) * std::sin(beyond)};
}

double release_angle(const RollerTrack& track) {
  return std::acos(std::clamp(1 - (2 * track.bore_radius - track.gap) / crank(track), 0.0, 1.0));
}

double outer_reach(const RollerTrack& track) {
  constexpr int samples = 256;
  const double released = release_angle(track);
  double reach = 0;
  for (int i = 0; i <= samples; ++i) {
    const double beyond = released * i / samples;
    reach = std::max(reach, centreline_radius(track) * beyond +
                                half_reach(track, gap_at(track, track.track_angle + beyond).gap));
  }
  return reach;
}

double closed_volume_per_turn(const RollerTrack& track) {
  return 2 * std::numbers::pi * centreline_radius(track) * open_area(track) -
         track.rollers * missing_volume(track, track.gap);
}

} // namespace undula::geometry
