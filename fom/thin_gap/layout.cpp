#include "fom/thin_gap/layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "fom/fom.hpp"
#include "geometry/mesh/passage_flow.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/wave_pump/profile_scale.hpp"
#include "geometry/wave_pump/wall_ray.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int samples_per_step = 16; // of the heights around a node
constexpr double tip_step = 0.25;    // first step of the free part, in parts of its mean step

/// What lies above and below the membrane at rest.
class Surroundings {
public:
  explicit Surroundings(const PumpProfile& profile) : profile_(profile), outline_(fluid_outline(profile)) {}

  WallOnRay wall(double r, bool up) const {
    const auto& membrane = profile_.membrane;
    const auto found = first_wall(outline_, r, skin(r, up), up);
    if (!found)
      throw InputError("the membrane has no wall " + std::string(up ? "above" : "below"),
                       "r = " + std::to_string(r) + " cm, z = " + std::to_string(membrane.mid_plane),
                       "walls, inlet or outlet above and below", profile_.file.string());
    return *found;
  }
  double height(double r, bool up) const {
    const double z = wall(r, up).z;
    return up ? z - skin(r, up) : skin(r, up) - z;
  }

private:
  double skin(double r, bool up) const {
    const double half = membrane_thickness(profile_.membrane, r) / 2;
    return profile_.membrane.mid_plane + (up ? half : -half);
  }
  const PumpProfile& profile_;
  FluidOutline outline_;
};

/// Where a ray stops to meet `curve`, going outwards from `from` to `to`: between two radii that meet it and
/// do not, by bisection. Empty if all or none of the radii meet it.
template <typename Meets>
std::optional<double> last_radius(double from, double to, const Meets& meets) {
  constexpr int scan = 2000;
  double low = 0, high = std::numeric_limits<double>::infinity();
  bool any = false;
  for (int i = 0; i <= scan; ++i) {
    const double r = from + (to - from) * i / scan;
    if (meets(r)) {
      low = r;
      any = true;
      high = std::numeric_limits<double>::infinity();
    } else {
      high = std::min(high, r);
    }
  }
  if (!any || !std::isfinite(high)) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (meets(middle) ? low : high) = middle;
  }
  return low;
}

/// Mean over the part of [low, high] within [from, to], weighted by the radius.
template <typename Function>
double radial_mean(double low, double high, double from, double to, const Function& f) {
  low = std::max(low, from);
  high = std::min(high, to);
  double sum = 0, weight = 0;
  for (int k = 0; k < samples_per_step; ++k) {
    const double r = low + (high - low) * (k + 0.5) / samples_per_step;
    sum += r * f(r);
    weight += r;
  }
  return sum / weight;
}

double distance(const std::vector<Point<2>>& line, const Point<2>& x) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i)
    least = std::min(least, distance_to_segment<2>(line[i - 1], line[i], x));
  return least;
}

/// Laminar friction between two walls, per viscosity: mean shear stress on both over their distance.
double developed_friction(double between_walls) { return 12 / (between_walls * between_walls); }

Passage passage_of(const PassageFlow& flow) { return {flow.inertance, flow.friction, flow.narrowest}; }

} // namespace

double face_radius(const ThinGapLayout& layout, int face) {
  if (face == 0) return layout.radius.front();
  if (face == static_cast<int>(layout.radius.size())) return layout.radius.back();
  return 0.5 * (layout.radius[face - 1] + layout.radius[face]);
}

double node_area(const ThinGapLayout& layout, int node) {
  const double low = face_radius(layout, node), high = face_radius(layout, node + 1);
  return pi * (high * high - low * low);
}

ThinGapLayout thin_gap_layout(const PumpProfile& profile, const SimplexMesh<2>& background,
                              double clamp_radius, int cells) {
  const auto& membrane = profile.membrane;
  const Surroundings around(profile);
  const auto refuse = [&](const char* what, double seen, const char* allowed) {
    throw InputError(what, std::to_string(seen) + " cm", allowed, profile.file.string());
  };

  // 1. Nodes.
  ThinGapLayout layout;
  const double extent = membrane.outer_radius - membrane.inner_radius;
  const int held = std::clamp(
      static_cast<int>(std::lround(cells * (membrane.outer_radius - clamp_radius) / extent)), 1, cells - 1);
  layout.clamp = cells - held; // a node stands exactly where the holder begins
  const double free_length = clamp_radius - membrane.inner_radius;
  const double held_step = (membrane.outer_radius - clamp_radius) / held;
  for (int i = 0; i <= cells; ++i) {
    // Steps grow linearly from the tip, where films close and jets leave.
    const double s = static_cast<double>(i) / layout.clamp;
    layout.radius.push_back(i <= layout.clamp
                                ? membrane.inner_radius + free_length * s * (tip_step + (1 - tip_step) * s)
                                : clamp_radius + held_step * (i - layout.clamp));
  }
  for (int i = 1; i <= cells; ++i)
    layout.step = std::max(layout.step, layout.radius[i] - layout.radius[i - 1]);
  for (const double r : layout.radius) layout.thickness.push_back(membrane_thickness(membrane, r));
  const auto node_at = [&](double r) {
    const auto next = std::upper_bound(layout.radius.begin(), layout.radius.end(), r);
    const auto node = static_cast<int>(next - layout.radius.begin()) - 1;
    return node < cells && layout.radius[node + 1] - r < r - layout.radius[node] ? node + 1 : node;
  };

  // 2. Where the inlet's channel begins, and where the bore ends.
  const auto upper_end = last_radius(membrane.inner_radius, membrane.outer_radius, [&](double r) {
    return around.wall(r, true).curve == FluidOutline::stator;
  });
  if (!upper_end)
    refuse("no channel leads to the gap above the membrane", membrane.outer_radius,
           "a stator that ends above the membrane, within its radius");
  const auto bore = last_radius(membrane.inner_radius, membrane.outer_radius, [&](double r) {
    return around.wall(r, false).curve == FluidOutline::outlet;
  });
  layout.channel = node_at(*upper_end);
  layout.lip = bore ? node_at(*bore) + 1 : 0;
  constexpr int least_cells = 4;
  if (layout.clamp < layout.lip + least_cells || layout.clamp > layout.channel || layout.channel >= cells)
    refuse("the membrane is not held between the gaps and the chambers", clamp_radius,
           "a clamp radius beyond the bore and below the end of the upper flange, and enough thin_gap.cells");

  // 3. Heights.
  const double channel_radius = *upper_end, bore_radius = bore.value_or(membrane.inner_radius);
  for (int i = 0; i <= cells; ++i) {
    const double low = face_radius(layout, i), high = face_radius(layout, i + 1);
    if (i <= layout.channel)
      layout.upper_height.push_back(radial_mean(low, high, membrane.inner_radius, channel_radius,
                                                [&](double r) { return around.height(r, true); }));
    const bool over_bore = i < layout.lip;
    layout.lower_height.push_back(radial_mean(low, high, over_bore ? membrane.inner_radius : bore_radius,
                                              over_bore ? bore_radius : membrane.outer_radius,
                                              [&](double r) { return around.height(r, false); }));
  }

  // 4. The holder, and the gap past the rim.
  const double chamber_from = face_radius(layout, layout.channel);
  layout.holder_area = pi * (membrane.outer_radius * membrane.outer_radius - chamber_from * chamber_from);
  const double past_rim = rim_gap(profile);
  if (!std::isfinite(past_rim))
    refuse("no wall surrounds the rim of the membrane", membrane.outer_radius,
           "a housing outside of it at its height");
  layout.rim.area = pi * past_rim * (2 * membrane.outer_radius + past_rim);
  layout.rim.inertance = layout.thickness.back() / layout.rim.area;
  layout.rim.resistance = developed_friction(past_rim) * layout.rim.inertance;

  // 5. The channels. Friction is that between walls that face each other; across the open bores it is small.
  const auto friction = [&](const Point<2>& x) {
    const double inwards = std::min(distance(profile.stator.points, x), distance(profile.magnet.points, x));
    return developed_friction(distance(profile.housing.points, x) + inwards);
  };
  const double channel_floor = around.wall(channel_radius * (1 - 1e-9), true).z;
  const auto in_magnet = [sides = polygon_sides(profile.magnet.points)](const Point<2>& x) {
    return inside_outline(sides, x);
  };
  layout.inlet = passage_of(passage_flow(
      background, "inlet", [&](const Point<2>& x) { return x.y() > channel_floor && !in_magnet(x); },
      [&](const Point<2>& x) { return !in_magnet(x); }, friction));
  const double tip = membrane.inner_radius;
  const double bore_top = around.wall(std::nextafter(bore_radius, 1e9), false).z;
  layout.outlet = passage_of(passage_flow(
      background, "outlet",
      [&](const Point<2>& x) { return x.x() < tip || (x.x() < bore_radius && x.y() < bore_top); },
      [](const Point<2>&) { return true; }, friction));
  return layout;
}

} // namespace undula::fom
