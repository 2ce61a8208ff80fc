#include "geometry/wave_pump/profile_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Lengths below this count as zero, cm.
double tolerance(const PumpProfile& profile) { return 1e-9 * profile.membrane.outer_radius; }

/// Height of the non-vertical edge a - b at radius r.
double height_at(const Point<2>& a, const Point<2>& b, double r) {
  const double s = std::clamp((r - a.x()) / (b.x() - a.x()), 0.0, 1.0);
  return (1 - s) * a.y() + s * b.y();
}

/// Upper (+1) or lower (-1) side of the membrane that a point faces.
double side_of(const PumpProfile& profile, const Point<2>& x) {
  return x.y() > profile.membrane.mid_plane ? 1.0 : -1.0;
}

double skin(const PumpProfile& profile, double r, double side) {
  return profile.membrane.mid_plane + side * 0.5 * membrane_thickness(profile.membrane, r);
}

/// Whether a wall point at a radius of the membrane is the first that its skin sees there.
bool is_first_seen(const PumpProfile& profile, const Point<2>& x) {
  const double side = side_of(profile, x);
  const double distance = side * (x.y() - skin(profile, x.x(), side));
  return distance > 0 && distance <= vertical_clearance(profile, x.x(), side > 0) + tolerance(profile);
}

/// A point of a wall and how it takes part in the scaling of the flanges.
struct WallPoint {
  enum class Moves { no, by_its_clearance, with_the_tip };
  Point<2> x;
  int line = 0;
  Moves moves = Moves::no;
};

/// One wall with the points added that its flange needs, marked by how they move.
class FlangeFinder {
public:
  FlangeFinder(const PumpProfile& profile, const ProfileCurve& wall)
      : profile_(profile),
        wall_(wall),
        tip_(profile.membrane.inner_radius),
        clamp_(profile.membrane.clamp_radius),
        small_(tolerance(profile)) {}

  std::vector<WallPoint> points() const {
    std::vector<WallPoint> all;
    for (std::size_t i = 0; i < wall_.points.size(); ++i) {
      all.push_back({wall_.points[i], line(i), moves(wall_.points[i])});
      if (i + 1 < wall_.points.size()) add_between(i, all);
    }
    return all;
  }

private:
  int line(std::size_t i) const { return wall_.lines.empty() ? 0 : wall_.lines[i]; }

  WallPoint::Moves moves(const Point<2>& x) const {
    const bool faces_membrane = x.x() >= tip_ - small_ && x.x() <= clamp_ + small_;
    return faces_membrane && is_first_seen(profile_, x) ? WallPoint::Moves::by_its_clearance
                                                        : WallPoint::Moves::no;
  }

  /// Points inside of edge i at the corners of the clearance, and the foot of the step at the clamp radius.
  void add_between(std::size_t i, std::vector<WallPoint>& all) const {
    const Point<2>&a = wall_.points[i], b = wall_.points[i + 1];
    const double low = std::max(std::min(a.x(), b.x()), tip_),
                 high = std::min(std::max(a.x(), b.x()), clamp_);
    if (std::abs(a.x() - b.x()) <= small_ || high < low - small_) return;
    const auto on_edge = [&](double r) { return Point<2>(r, height_at(a, b, r)); };
    if (moves(on_edge(low)) == WallPoint::Moves::no || moves(on_edge(high)) == WallPoint::Moves::no) return;

    std::vector<WallPoint> added;
    std::vector<double> radii{tip_, clamp_};
    for (const auto& corner : profile_.membrane.thickness.points)
      if (corner.x() > tip_ + small_ && corner.x() < clamp_ - small_) radii.push_back(corner.x());
    std::sort(radii.begin(), radii.end());
    for (const double r : radii)
      if (r > std::min(a.x(), b.x()) + small_ && r < std::max(a.x(), b.x()) - small_)
        added.push_back({on_edge(r), line(i), WallPoint::Moves::by_its_clearance});
    if (std::max(a.x(), b.x()) > clamp_ + small_)
      added.push_back({on_edge(clamp_), line(i), WallPoint::Moves::no});
    if (a.x() > b.x()) std::reverse(added.begin(), added.end());
    all.insert(all.end(), added.begin(), added.end());
  }

  const PumpProfile& profile_;
  const ProfileCurve& wall_;
  double tip_, clamp_, small_; ///< cm
};

/// Marks what goes on from the flange at the tip radius towards the axis; returns the point at the tip.
std::optional<Point<2>> mark_continuation(std::vector<WallPoint>& wall, double tip, double small,
                                          bool to_the_end) {
  for (std::size_t i = 0; i < wall.size(); ++i) {
    if (wall[i].moves == WallPoint::Moves::no || std::abs(wall[i].x.x() - tip) > small) continue;
    for (std::size_t j = i + 1; j < wall.size(); ++j) {
      if (!to_the_end && wall[j].x.x() >= wall[j - 1].x.x() - small) break;
      if (wall[j].moves == WallPoint::Moves::no) wall[j].moves = WallPoint::Moves::with_the_tip;
    }
    return wall[i].x;
  }
  return std::nullopt;
}

/// Refuses a flange that moves past the end of the still wall it adjoins: the bore would turn inside out.
void check_order(const PumpProfile& profile, const std::vector<WallPoint>& before, const ProfileCurve& after,
                 double scale) {
  for (std::size_t i = 1; i < before.size(); ++i) {
    if ((before[i - 1].moves == WallPoint::Moves::no) == (before[i].moves == WallPoint::Moves::no)) continue;
    const double rise = before[i].x.y() - before[i - 1].x.y();
    const double rise_after = after.points[i].y() - after.points[i - 1].y();
    if (rise == 0 || rise * rise_after > 0) continue;
    std::ostringstream seen, allowed;
    seen << "clearance_scale = " << scale << ", from z = " << before[i - 1].x.y() << ", " << before[i].x.y()
         << " to z = " << after.points[i - 1].y() << ", " << after.points[i].y()
         << " at r = " << before[i].x.x();
    allowed << "a factor that leaves the points of '" << after.key << "' in order, nearer to 1";
    throw InputError("a flange would move past the wall it adjoins", seen.str(), allowed.str(),
                     profile.file.string() + ":" + std::to_string(before[i].line));
  }
}

ProfileCurve scaled_wall(const PumpProfile& profile, const ProfileCurve& wall, double scale,
                         bool nose_to_the_end) {
  const auto shift = [&](const Point<2>& x) {
    const double side = side_of(profile, x);
    return (scale - 1) * (x.y() - skin(profile, x.x(), side));
  };
  auto points = FlangeFinder(profile, wall).points();
  const auto tip =
      mark_continuation(points, profile.membrane.inner_radius, tolerance(profile), nose_to_the_end);

  ProfileCurve moved;
  moved.key = wall.key;
  for (const auto& point : points) {
    Point<2> x = point.x;
    if (point.moves == WallPoint::Moves::by_its_clearance) x.y() += shift(x);
    if (point.moves == WallPoint::Moves::with_the_tip) x.y() += shift(*tip);
    moved.points.push_back(x);
    if (!wall.lines.empty()) moved.lines.push_back(point.line);
  }
  check_order(profile, points, moved, scale);
  return moved;
}

void check_scale(const PumpProfile& profile, const char* name, double scale) {
  if (std::isfinite(scale) && scale > 0) return;
  std::ostringstream seen;
  seen << name << " = " << scale;
  throw InputError("a gap cannot be multiplied by this factor", seen.str(), "a finite number above 0",
                   profile.file.string());
}

} // namespace

double vertical_clearance(const PumpProfile& profile, double r, bool above) {
  const double side = above ? 1.0 : -1.0;
  const double from = skin(profile, r, side);
  const double small = tolerance(profile);
  double nearest = infinity;
  const auto see = [&](double z) {
    if (side * (z - from) > 0) nearest = std::min(nearest, side * (z - from));
  };
  for (const auto* wall : {&profile.housing, &profile.stator})
    for (std::size_t i = 1; i < wall->points.size(); ++i) {
      const Point<2>&a = wall->points[i - 1], b = wall->points[i];
      if (r < std::min(a.x(), b.x()) - small || r > std::max(a.x(), b.x()) + small) continue;
      if (std::abs(a.x() - b.x()) <= small) {
        see(a.y());
        see(b.y());
      } else {
        see(height_at(a, b, r));
      }
    }
  return nearest;
}

double rim_gap(const PumpProfile& profile) {
  const auto& membrane = profile.membrane;
  const double low = skin(profile, membrane.outer_radius, -1), high = skin(profile, membrane.outer_radius, 1);
  double nearest = infinity;
  const auto see = [&](double r) {
    if (r > membrane.outer_radius) nearest = std::min(nearest, r - membrane.outer_radius);
  };
  for (std::size_t i = 1; i < profile.housing.points.size(); ++i) {
    const Point<2>&a = profile.housing.points[i - 1], b = profile.housing.points[i];
    // The ends of the part of the edge that lies beside the rim.
    const double from = std::max(std::min(a.y(), b.y()), low), to = std::min(std::max(a.y(), b.y()), high);
    if (from > to) continue;
    for (const double z : {from, to}) {
      const double s = a.y() == b.y() ? 0.0 : (z - a.y()) / (b.y() - a.y());
      see((1 - s) * a.x() + s * b.x());
    }
    if (a.y() == b.y()) see(b.x());
  }
  return nearest;
}

PumpProfile scale_clearances(const PumpProfile& profile, double clearance_scale, double rim_gap_scale) {
  check_scale(profile, "clearance_scale", clearance_scale);
  check_scale(profile, "rim_gap_scale", rim_gap_scale);
  PumpProfile scaled = profile;
  if (clearance_scale != 1) {
    scaled.housing = scaled_wall(profile, profile.housing, clearance_scale, false);
    scaled.stator = scaled_wall(profile, profile.stator, clearance_scale, true);
  }
  if (rim_gap_scale != 1) {
    const double gap = rim_gap(profile);
    if (gap == infinity)
      throw InputError("the profile has no gap at the membrane's rim", "no housing beside the rim",
                       "rim_gap_scale = 1, or a housing around the membrane", profile.file.string());
    scaled.membrane.outer_radius += (1 - rim_gap_scale) * gap;
    scaled.membrane.thickness.points.back().x() = scaled.membrane.outer_radius;
  }
  if (clearance_scale == 1 && rim_gap_scale == 1) return scaled;
  try {
    check_pump_profile(scaled);
  } catch (const InputError& error) {
    std::string reason = error.what();
    reason.erase(std::min(reason.find('\n'), reason.size()));
    std::ostringstream seen;
    seen << "clearance_scale = " << clearance_scale << ", rim_gap_scale = " << rim_gap_scale;
    throw InputError("the gaps of the profile cannot be scaled so far: " + reason, seen.str(),
                     "factors that leave the walls in order, nearer to 1", profile.file.string());
  }
  return scaled;
}

} // namespace undula::geometry
