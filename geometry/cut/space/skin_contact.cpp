#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "geometry/cut/space/orientation.hpp"
#include "geometry/cut/space/skin_surface.hpp"
#include "geometry/mesh/box_grid.hpp"

namespace undula::geometry {
namespace {

using Corners = std::array<Point<3>, 3>;

// 1 if the plane with this normal through `on` has all points certainly on the side of the normal, -1 if on
// the other, 0 if neither is certain. The normal is taken as it is, the rest is rounding of differences.
int common_side(const Point<3>& normal, const Point<3>& on, std::span<const Point<3>> points) {
  int side = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<3> from = points[i] - on;
    const double value = normal.dot(from);
    const double error = 1e-15 * (normal.cwiseAbs().dot(from.cwiseAbs()) +
                                  normal.cwiseAbs().dot(points[i].cwiseAbs() + on.cwiseAbs())) +
                         1e-300;
    const int sign = value > error ? 1 : value < -error ? -1 : 0;
    if (sign == 0 || (i > 0 && sign != side)) return 0;
    side = sign;
  }
  return side;
}

// The side of a plane through a triangle on which all points certainly are, 0 if that is not certain.
int side_of_plane(const Corners& t, std::span<const Point<3>> points) {
  int side = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int sign = orientation(t[0], t[1], t[2], points[i]).sign();
    if (sign == 0 || (i > 0 && sign != side)) return 0;
    side = sign;
  }
  return side;
}

// Whether the segment certainly misses the triangle.
bool misses(const Point<3>& p, const Point<3>& q, const Corners& t) {
  const int at_p = orientation(t[0], t[1], t[2], p).sign(), at_q = orientation(t[0], t[1], t[2], q).sign();
  if (at_p != 0 && at_p == at_q) return true;
  int lowest = 1, highest = -1;
  for (int i = 0; i < 3; ++i) {
    const int sign = orientation(p, q, t[i], t[(i + 1) % 3]).sign();
    lowest = std::min(lowest, sign);
    highest = std::max(highest, sign);
  }
  return lowest < 0 && highest > 0; // the line passes outside
}

struct Way {
  Point<3> from, vector;
};

// The shortest way from a segment to another one.
Way between_segments(const Point<3>& p, const Point<3>& q, const Point<3>& a, const Point<3>& b) {
  const Point<3> d = q - p, e = b - a, r = p - a;
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dr = d.dot(r), er = e.dot(r);
  const double det = dd * ee - de * de;
  double s = det > 1e-12 * dd * ee ? std::clamp((de * er - ee * dr) / det, 0.0, 1.0) : 0.5;
  const double t = std::clamp((de * s + er) / ee, 0.0, 1.0);
  s = std::clamp((de * t - dr) / dd, 0.0, 1.0);
  return {p + s * d, a + t * e - (p + s * d)};
}

// The vector from a triangle to a point above or below it; nothing from it to points beside it.
std::optional<Point<3>> from_triangle(const Corners& t, const Point<3>& x) {
  const Point<3> normal = (t[1] - t[0]).cross(t[2] - t[0]);
  for (int i = 0; i < 3; ++i)
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) < 0) return std::nullopt;
  return normal.dot(x - t[0]) / normal.squaredNorm() * normal;
}

bool apart(const Corners& s, const Corners& t) {
  if (side_of_plane(s, t) != 0 || side_of_plane(t, s) != 0) return true;
  bool missing = true;
  for (int i = 0; i < 3 && missing; ++i)
    missing = misses(s[i], s[(i + 1) % 3], t) && misses(t[i], t[(i + 1) % 3], s);
  if (missing) return true;
  // A plane across the shortest way from one to the other.
  Way way{s[0], t[0] - s[0]};
  const auto take = [&](const Way& other) {
    if (other.vector.squaredNorm() < way.vector.squaredNorm()) way = other;
  };
  for (int i = 0; i < 3; ++i) {
    if (const auto up = from_triangle(s, t[i])) take({t[i] - *up, *up});
    if (const auto up = from_triangle(t, s[i])) take({s[i], -*up});
    for (int j = 0; j < 3; ++j) take(between_segments(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
  }
  const Point<3> middle = way.from + 0.5 * way.vector;
  return common_side(way.vector, middle, s) * common_side(way.vector, middle, t) < 0;
}

// Triangles (v, a, b) and (v, c, d) that share the point v: a plane between them through v has all of a - v,
// b - v, v - c, v - d on one side. The shortest vector in the hull of their directions is its normal.
bool share_the_point_only(const Point<3>& v, const std::array<Point<3>, 2>& a,
                          const std::array<Point<3>, 2>& c) {
  const std::array<Point<3>, 4> y{(a[0] - v).normalized(), (a[1] - v).normalized(), (v - c[0]).normalized(),
                                  (v - c[1]).normalized()};
  const auto parts_them = [&](const Point<3>& normal) {
    for (const auto& direction : y)
      if (!(normal.dot(direction) > 0)) return false;
    return common_side(normal, v, a) * common_side(normal, v, c) < 0;
  };
  if (parts_them(y[0] + y[1] + y[2] + y[3])) return true;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const Point<3> along = y[j] - y[i];
      if (along.squaredNorm() == 0) continue;
      const Point<3> nearest = y[i] - y[i].dot(along) / along.squaredNorm() * along;
      if (parts_them(nearest)) return true;
    }
  for (int i = 0; i < 4; ++i) {
    const auto &p = y[(i + 1) % 4], &q = y[(i + 2) % 4], &r = y[(i + 3) % 4];
    const Point<3> normal = (q - p).cross(r - p);
    if (parts_them(normal.dot(p) > 0 ? normal : Point<3>(-normal))) return true;
  }
  const Corners s{v, a[0], a[1]}, t{v, c[0], c[1]};
  if (side_of_plane(s, c) != 0 || side_of_plane(t, a) != 0) return true;
  return misses(a[0], a[1], t) && misses(c[0], c[1], s);
}

// Triangles that share the edge from v to w: they share more if the one is folded onto the other.
bool share_the_edge_only(const Point<3>& v, const Point<3>& w, const Point<3>& a, const Point<3>& b) {
  if (orientation(v, w, a, b).sign() != 0) return true;
  const Point<3> along = w - v;
  const Point<3> to_a = a - v - (a - v).dot(along) / along.squaredNorm() * along;
  const Point<3> to_b = b - v - (b - v).dot(along) / along.squaredNorm() * along;
  return to_a.dot(to_b) < -0.5 * to_a.norm() * to_b.norm(); // both in one plane, on either side of the edge
}

bool certainly_apart(const SkinTriangle& s, const SkinTriangle& t, std::span<const Point<3>> x) {
  std::array<int, 3> shared{}, of_s{}, of_t{};
  int n = 0, m = 0, k = 0;
  for (const int p : s.points)
    if (std::find(t.points.begin(), t.points.end(), p) != t.points.end())
      shared[n++] = p;
    else
      of_s[m++] = p;
  for (const int p : t.points)
    if (std::find(s.points.begin(), s.points.end(), p) == s.points.end()) of_t[k++] = p;
  switch (n) {
    case 0:
      return apart({x[s.points[0]], x[s.points[1]], x[s.points[2]]},
                   {x[t.points[0]], x[t.points[1]], x[t.points[2]]});
    case 1:
      return share_the_point_only(x[shared[0]], {x[of_s[0]], x[of_s[1]]}, {x[of_t[0]], x[of_t[1]]});
    case 2:
      return share_the_edge_only(x[shared[0]], x[shared[1]], x[of_s[0]], x[of_t[0]]);
    default:
      return false;
  }
}

} // namespace

std::vector<int> touching_triangles(const SkinSurface& skin, std::span<const Point<3>> placed) {
  std::vector<Box<3>> boxes;
  boxes.reserve(skin.triangles.size());
  for (const auto& t : skin.triangles) {
    const auto &a = placed[t.points[0]], &b = placed[t.points[1]], &c = placed[t.points[2]];
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
  }
  const auto box_of = boxes;
  const BoxGrid<3> grid(std::move(boxes));
  std::vector<int> touching;
  for (int s = 0; s < static_cast<int>(skin.triangles.size()); ++s)
    for (const int t : grid.touching(box_of[s]))
      if (t > s && !certainly_apart(skin.triangles[s], skin.triangles[t], placed)) {
        touching.push_back(s);
        touching.push_back(t);
      }
  for (int t = 0; t < static_cast<int>(skin.triangles.size()); ++t)
    for (const int e : skin.triangles[t].edges)
      if (skin.edges[e].pinched) touching.push_back(t);
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  return touching;
}

} // namespace undula::geometry
