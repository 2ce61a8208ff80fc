#include "fom/long_wave/hose_picture.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "fom/long_wave/hose_pressures.hpp"
#include "fom/scene/scene_time.hpp"
#include "geometry/hose/flattened_bore.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

constexpr int stations = 600, roller_corners = 32;

/// Point and outward normal of the centreline; the arc is symmetric about the y axis and runs
/// counterclockwise.
struct OnCentreline {
  Point<2> point, tangent, normal;
};

OnCentreline on_centreline(const HoseModel& model, double position) {
  const double radius = geometry::centreline_radius(model.track), arc = radius * model.track.track_angle;
  const double along = position - model.hose.inlet_length;
  const double on_arc = std::clamp(along, 0.0, arc);
  const double angle = pi / 2 - model.track.track_angle / 2 + on_arc / radius;
  OnCentreline at;
  at.normal = {std::cos(angle), std::sin(angle)};
  at.tangent = {-std::sin(angle), std::cos(angle)};
  at.point = radius * at.normal + (along - on_arc) * at.tangent;
  return at;
}

/// Positions of the stations, cm from the inlet.
std::vector<double> station_positions(const HoseModel& model) {
  const double most = 2 * model.track.track_radius;
  const double begin = std::max(0.0, model.hose.inlet_length - most);
  const double end = model.length - std::max(0.0, model.hose.outlet_length - most);
  std::vector<double> positions;
  for (int i = 0; i < stations; ++i) positions.push_back(begin + (end - begin) * i / (stations - 1));
  return positions;
}

/// Adds the strip between two distances (by station) along the outward normal.
void add_strip(FieldMesh<2>& mesh, const HoseModel& model, const std::function<double(std::size_t)>& inner,
               const std::function<double(std::size_t)>& outer) {
  const auto positions = station_positions(model);
  const int first = static_cast<int>(mesh.points.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const OnCentreline at = on_centreline(model, positions[i]);
    mesh.points.push_back(at.point + inner(i) * at.normal);
    mesh.points.push_back(at.point + outer(i) * at.normal);
  }
  for (int i = 0; i + 1 < stations; ++i) {
    const int at = first + 2 * i;
    mesh.cells.push_back({at, at + 1, at + 3});
    mesh.cells.push_back({at, at + 3, at + 2});
  }
}

struct AtStation {
  double height = 0; ///< cm
  double flow = 0;   ///< cm^3/s
};

/// Bore and flow at the stations.
std::vector<AtStation> bores(const HoseModel& model, const HoseInstant& instant, double outflow) {
  std::vector<AtStation> result;
  for (const double position : station_positions(model)) {
    AtStation at{2 * model.track.bore_radius, outflow};
    for (const SqueezedPlace& place : instant.places) {
      const double offset = position - place.at.position;
      if (offset < -place.reach) at.flow += place.left_added;
      if (std::abs(offset) > place.reach) continue;
      at.height = place_height(model, place.at, offset);
      at.flow += added_flow(model, place.at, offset);
    }
    result.push_back(at);
  }
  return result;
}

Point<2> roller_axis(const HoseModel& model, double frequency, double time, int roller) {
  const double angle = pi / 2 - model.track.track_angle / 2 + roller_angle(model, frequency, time, roller);
  return geometry::crank(model.track) * Point<2>(std::cos(angle), std::sin(angle));
}

} // namespace

FieldMesh<2> lumen_at_rest(const HoseModel& model) {
  const double a = model.track.bore_radius;
  FieldMesh<2> mesh;
  add_strip(
      mesh, model, [&](std::size_t) { return -a; }, [&](std::size_t) { return a; });
  return mesh;
}

FieldMesh<2> lumen(const HoseModel& model, double frequency, const State& state) {
  const double a = model.track.bore_radius;
  const auto bore = bores(model, hose_at(model, frequency, state.time), state.x[0][0]);
  FieldMesh<2> mesh;
  add_strip(
      mesh, model, [&](std::size_t i) { return a - bore[i].height; }, [&](std::size_t) { return a; });
  return mesh;
}

FieldMesh<2> walls_and_rollers(const HoseModel& model) {
  const double a = model.track.bore_radius, wall = model.hose.wall;
  FieldMesh<2> mesh;
  add_strip(
      mesh, model, [&](std::size_t) { return a; }, [&](std::size_t) { return a + wall; });
  add_strip(
      mesh, model, [&](std::size_t) { return -a - wall; }, [&](std::size_t) { return -a; });
  for (int roller = 0; roller < model.track.rollers; ++roller) {
    const Point<2> axis = roller_axis(model, 1, 0, roller);
    const int centre = static_cast<int>(mesh.points.size());
    mesh.points.push_back(axis);
    for (int k = 0; k < roller_corners; ++k) {
      const double angle = 2 * pi * k / roller_corners;
      mesh.points.push_back(axis + model.track.roller_radius * Point<2>(std::cos(angle), std::sin(angle)));
      mesh.cells.push_back({centre, centre + 1 + k, centre + 1 + (k + 1) % roller_corners});
    }
  }
  return mesh;
}

std::vector<NodalField> lumen_fields(const HoseModel& model, const Scene& scene, const State& state) {
  const HoseInstant instant = hose_at(model, scene.operating_point.frequency, state.time);
  const auto bore = bores(model, instant, state.x[0][0]);
  const HosePressures line = hose_pressures(model, instant, scene.operating_point.head, state.x[0][0],
                                            (state.x[0][0] - state.x[1][0]) / time_step(scene));
  const auto positions = station_positions(model);
  NodalField velocity{"velocity", "cm/s", 2, {}}, pressure{"pressure", "dyn/cm^2", 1, {}};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double area = geometry::flattened_area(model.track.bore_radius, bore[i].height);
    const Point<2> along = bore[i].flow / area * on_centreline(model, positions[i]).tangent;
    for (int side = 0; side < 2; ++side) {
      velocity.values.insert(velocity.values.end(), {along[0], along[1]});
      pressure.values.push_back(line.at(positions[i]));
    }
  }
  return {velocity, pressure};
}

std::vector<NodalField> wall_fields(const HoseModel& model, double frequency, const State& state) {
  const double open = 2 * model.track.bore_radius;
  const auto bore = bores(model, hose_at(model, frequency, state.time), state.x[0][0]);
  const auto positions = station_positions(model);
  NodalField displacement{"displacement", "cm", 2, std::vector<double>(4 * positions.size(), 0.0)};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Point<2> moved = (open - bore[i].height) * on_centreline(model, positions[i]).normal;
    for (int side = 0; side < 2; ++side)
      displacement.values.insert(displacement.values.end(), {moved[0], moved[1]});
  }
  for (int roller = 0; roller < model.track.rollers; ++roller) {
    const Point<2> moved =
        roller_axis(model, frequency, state.time, roller) - roller_axis(model, 1, 0, roller);
    for (int k = 0; k <= roller_corners; ++k)
      displacement.values.insert(displacement.values.end(), {moved[0], moved[1]});
  }
  return {displacement, {"velocity", "cm/s", 2, std::vector<double>(displacement.values.size(), 0.0)}};
}

} // namespace undula::fom
