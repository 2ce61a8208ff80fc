#include "geometry/cut/space/convex_fill.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace undula::geometry {
namespace {

constexpr int solid = -1;
constexpr int unknown = -2;

int side_of(double distance, double tolerance) {
  return distance > tolerance ? 1 : distance < -tolerance ? -1 : 0;
}

double distance(const SkinPolygon& plane, const Point<3>& x) { return plane.normal.dot(x) - plane.offset; }

// Lowest and highest side of the corners of a polygon.
std::pair<int, int> sides(const SkinPolygon& plane, const ConvexPolygon& polygon, double tolerance) {
  int lowest = 1, highest = -1;
  for (int i = 0; i < polygon.count; ++i) {
    const int side = side_of(distance(plane, polygon.x[i]), tolerance);
    lowest = std::min(lowest, side);
    highest = std::max(highest, side);
  }
  return {lowest, highest};
}

// The two halves of a polygon with corners on either side. False if one has too many corners.
bool clip(const SkinPolygon& plane, const ConvexPolygon& polygon, double tolerance, ConvexPolygon& above,
          ConvexPolygon& below) {
  above.count = below.count = 0;
  if (polygon.count + 2 > ConvexPolygon::most) return false;
  for (int i = 0; i < polygon.count; ++i) {
    const auto &a = polygon.x[i], &b = polygon.x[(i + 1) % polygon.count];
    const double at_a = distance(plane, a), at_b = distance(plane, b);
    const int side_a = side_of(at_a, tolerance), side_b = side_of(at_b, tolerance);
    if (side_a >= 0) above.x[above.count++] = a;
    if (side_a <= 0) below.x[below.count++] = a;
    if (side_a * side_b < 0)
      above.x[above.count++] = below.x[below.count++] = a + at_a / (at_a - at_b) * (b - a);
  }
  return true;
}

} // namespace

double area(const ConvexPolygon& polygon) {
  Point<3> twice = Point<3>::Zero();
  for (int i = 1; i + 1 < polygon.count; ++i)
    twice += (polygon.x[i] - polygon.x[0]).cross(polygon.x[i + 1] - polygon.x[0]);
  return twice.norm() / 2;
}

bool ConvexFill::fill(const std::array<Point<3>, 4>& corners, std::span<const SkinPolygon> polygons,
                      double tolerance) {
  tolerance_ = tolerance;
  polygons_ = polygons;
  simplices_.clear();
  int stack = 1;
  if (pieces_.empty()) pieces_.emplace_back();
  auto& first = pieces_[0];
  first.shape.points = first.shape.faces = 4;
  constexpr std::uint8_t outward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int i = 0; i < 4; ++i) {
    first.shape.x[i] = corners[i];
    first.shape.count[i] = 3;
    std::copy(outward[i], outward[i] + 3, first.shape.corner[i].begin());
  }
  first.members.clear();
  for (int p = 0; p < static_cast<int>(polygons.size()); ++p)
    first.members.push_back({p, 0, polygons[p].shape});
  while (stack > 0) {
    std::swap(current_, pieces_[--stack]);
    const int plane = next_plane(current_);
    if (plane < 0) {
      if (!add_leaf(current_)) return false;
      continue;
    }
    while (static_cast<int>(pieces_.size()) < stack + 2) pieces_.emplace_back();
    bool parted;
    if (!split(plane, current_, pieces_[stack], pieces_[stack + 1], parted)) return false;
    stack += parted ? 2 : 1;
  }
  return true;
}

// The polygon whose plane parts the fewest others, the largest among them; -1 if there is none inside.
int ConvexFill::next_plane(const Piece& piece) const {
  constexpr int compared = 12;
  int best = -1, least_parted = 0, tried = 0;
  double largest = 0;
  for (const auto& member : piece.members) {
    if (member.side != 0) continue;
    if (++tried > compared) break;
    int parted = 0;
    for (const auto& other : piece.members) {
      if (other.side != 0 || &other == &member) continue;
      const auto [lowest, highest] = sides(polygons_[member.polygon], other.shape, tolerance_);
      parted += lowest < 0 && highest > 0;
    }
    const double size = area(member.shape);
    if (best >= 0 && (parted > least_parted || (parted == least_parted && size <= largest))) continue;
    best = member.polygon;
    least_parted = parted;
    largest = size;
  }
  return best;
}

bool ConvexFill::split(int polygon, const Piece& piece, Piece& above, Piece& below, bool& parted) {
  const auto& plane = polygons_[polygon];
  const auto& shape = piece.shape;
  double at[Polytope::most_points];
  int side[Polytope::most_points];
  int lowest = 1, highest = -1;
  for (int i = 0; i < shape.points; ++i) {
    at[i] = distance(plane, shape.x[i]);
    side[i] = side_of(at[i], tolerance_);
    lowest = std::min(lowest, side[i]);
    highest = std::max(highest, side[i]);
  }
  parted = lowest < 0 && highest > 0;
  if (!parted && lowest == 0 && highest == 0) return false;

  // Members first: those in the plane bound both pieces.
  above.members.clear();
  below.members.clear();
  for (const auto& member : piece.members) {
    const auto [low, high] =
        member.polygon == polygon ? std::pair(0, 0) : sides(plane, member.shape, tolerance_);
    if (low == 0 && high == 0) {
      if (member.side != 0) continue; // has become an edge of the pieces
      const double cosine = polygons_[member.polygon].normal.dot(plane.normal);
      if (!(cosine > 0.5) && area(member.shape) > tolerance_ * tolerance_) return false;
      above.members.push_back({member.polygon, 1, member.shape});
      below.members.push_back({member.polygon, -1, member.shape});
    } else if (low >= 0) {
      above.members.push_back(member);
    } else if (high <= 0) {
      below.members.push_back(member);
    } else {
      auto& upper = above.members.emplace_back(Member{member.polygon, member.side, {}});
      auto& lower = below.members.emplace_back(Member{member.polygon, member.side, {}});
      if (!clip(plane, member.shape, tolerance_, upper.shape, lower.shape)) return false;
    }
  }
  if (!parted) { // the plane runs along the boundary of the piece
    if (highest <= 0) std::swap(above.members, below.members);
    if (!below.members.empty())
      for (const auto& member : below.members)
        if (member.side == 0) return false;
    above.shape = shape;
    return true;
  }

  struct Cut {
    int low, high, above, below;
  };
  Cut cuts[Polytope::most_points];
  int cut_count = 0;
  int in_above[Polytope::most_points], in_below[Polytope::most_points];
  above.shape.points = below.shape.points = above.shape.faces = below.shape.faces = 0;
  for (int i = 0; i < shape.points; ++i) {
    if (side[i] >= 0) above.shape.x[in_above[i] = above.shape.points++] = shape.x[i];
    if (side[i] <= 0) below.shape.x[in_below[i] = below.shape.points++] = shape.x[i];
  }
  // Of the cap: the point after each, in the direction of its outline.
  std::uint8_t after_above[Polytope::most_points], after_below[Polytope::most_points];
  std::fill(std::begin(after_above), std::end(after_above), std::uint8_t{255});
  std::fill(std::begin(after_below), std::end(after_below), std::uint8_t{255});
  struct Half {
    std::uint8_t corner[Polytope::most_corners + 2];
    bool on[Polytope::most_corners + 2];
    int count;
  };
  bool tangled = false; // points so near to each other that rounding spoils the outline
  const auto take = [&tangled](Polytope& half_shape, const Half& half, std::uint8_t* after) {
    if (half.count < 3) return true;
    if (half.count > Polytope::most_corners || half_shape.faces >= Polytope::most_faces - 1) return false;
    const int face = half_shape.faces++;
    half_shape.count[face] = static_cast<std::uint8_t>(half.count);
    std::copy(half.corner, half.corner + half.count, half_shape.corner[face].begin());
    for (int i = 0; i < half.count; ++i) {
      const int j = (i + 1) % half.count;
      if (!half.on[i] || !half.on[j]) continue;
      tangled = tangled || after[half.corner[j]] != 255;
      after[half.corner[j]] = half.corner[i]; // the cap goes along the edge the other way
    }
    return true;
  };
  for (int f = 0; f < shape.faces; ++f) {
    Half upper{}, lower{};
    bool has_above = false, has_below = false;
    for (int i = 0; i < shape.count[f]; ++i) {
      const int a = shape.corner[f][i], b = shape.corner[f][(i + 1) % shape.count[f]];
      has_above = has_above || side[a] > 0;
      has_below = has_below || side[a] < 0;
      const auto push = [](Half& half, int corner, bool on) {
        half.corner[half.count] = static_cast<std::uint8_t>(corner);
        half.on[half.count++] = on;
      };
      if (side[a] >= 0) push(upper, in_above[a], side[a] == 0);
      if (side[a] <= 0) push(lower, in_below[a], side[a] == 0);
      if (side[a] * side[b] >= 0) continue;
      const int low = std::min(a, b), high = std::max(a, b);
      int c = 0;
      while (c < cut_count && (cuts[c].low != low || cuts[c].high != high)) ++c;
      if (c == cut_count) {
        if (above.shape.points >= Polytope::most_points || below.shape.points >= Polytope::most_points)
          return false;
        const Point<3> x = shape.x[low] + at[low] / (at[low] - at[high]) * (shape.x[high] - shape.x[low]);
        cuts[cut_count++] = {low, high, above.shape.points, below.shape.points};
        above.shape.x[above.shape.points++] = below.shape.x[below.shape.points++] = x;
      }
      push(upper, cuts[c].above, true);
      push(lower, cuts[c].below, true);
    }
    if (has_above && !take(above.shape, upper, after_above)) return false;
    if (has_below && !take(below.shape, lower, after_below)) return false;
  }
  const auto link = [](Polytope& half, const std::uint8_t* after) {
    int start = 0;
    while (start < half.points && after[start] == 255) ++start;
    if (start == half.points) return false;
    int count = 0;
    for (int p = start; count == 0 || p != start; p = after[p]) {
      if (count == Polytope::most_corners || after[p] == 255) return false;
      half.corner[half.faces][count++] = static_cast<std::uint8_t>(p);
    }
    half.count[half.faces] = static_cast<std::uint8_t>(count);
    int linked = 0;
    for (int p = 0; p < half.points; ++p) linked += after[p] != 255;
    return count >= 3 && linked == count;
  };
  // The points in the plane by their angle about their middle, counter-clockwise seen along `up`.
  const auto sort = [&](Polytope& half, const Point<3>& up) {
    std::array<std::pair<double, std::uint8_t>, Polytope::most_corners> corners;
    int count = 0;
    Point<3> middle = Point<3>::Zero();
    for (int p = 0; p < half.points; ++p) {
      if (side_of(distance(plane, half.x[p]), 2 * tolerance_) != 0) continue;
      if (count == Polytope::most_corners) return false;
      corners[count++].second = static_cast<std::uint8_t>(p);
      middle += half.x[p];
    }
    if (count < 3) return false;
    middle /= count;
    const Point<3> first = up.unitOrthogonal(), second = up.cross(first);
    for (int i = 0; i < count; ++i) {
      const Point<3> x = half.x[corners[i].second] - middle;
      corners[i].first = std::atan2(second.dot(x), first.dot(x));
    }
    std::sort(corners.begin(), corners.begin() + count);
    for (int i = 0; i < count; ++i) half.corner[half.faces][i] = corners[i].second;
    half.count[half.faces] = static_cast<std::uint8_t>(count);
    return true;
  };
  if ((tangled || !link(above.shape, after_above)) && !sort(above.shape, -plane.normal)) return false;
  if ((tangled || !link(below.shape, after_below)) && !sort(below.shape, plane.normal)) return false;
  ++above.shape.faces;
  ++below.shape.faces;
  return true;
}

// By the first polygon on the way from a point inside to the largest polygon.
int ConvexFill::part_by_ray(const Polytope& shape) const {
  const SkinPolygon* target = nullptr;
  double largest = 0;
  for (const auto& polygon : polygons_)
    if (const double size = area(polygon.shape); size > largest) {
      largest = size;
      target = &polygon;
    }
  if (!target) return unknown;
  Point<3> from = Point<3>::Zero(), to = Point<3>::Zero();
  for (int i = 0; i < shape.points; ++i) from += shape.x[i] / shape.points;
  for (int i = 0; i < target->shape.count; ++i) to += target->shape.x[i] / target->shape.count;
  double nearest = std::numeric_limits<double>::infinity();
  int part = unknown;
  for (const auto& polygon : polygons_) {
    const double start = distance(polygon, from), end = distance(polygon, to);
    if (start == end) continue;
    const double t = start / (start - end);
    if (t < 0 || t > 1 + 1e-9 || t >= nearest) continue;
    const Point<3> x = from + t * (to - from);
    Point<3> twice = Point<3>::Zero();
    for (int i = 1; i + 1 < polygon.shape.count; ++i)
      twice += (polygon.shape.x[i] - polygon.shape.x[0]).cross(polygon.shape.x[i + 1] - polygon.shape.x[0]);
    bool inside = true;
    for (int i = 0; i < polygon.shape.count && inside; ++i) {
      const auto &a = polygon.shape.x[i], &b = polygon.shape.x[(i + 1) % polygon.shape.count];
      inside = (b - a).cross(x - a).dot(twice) >= -1e-12 * twice.squaredNorm();
    }
    if (!inside) continue;
    nearest = t;
    part = end > start ? polygon.part : solid;
  }
  return part;
}

bool ConvexFill::add_leaf(const Piece& piece) {
  const auto& shape = piece.shape;
  int part = unknown;
  double largest = 0, extent = 0;
  for (int i = 1; i < shape.points; ++i) extent = std::max(extent, (shape.x[i] - shape.x[0]).squaredNorm());
  for (const auto& member : piece.members)
    if (const double size = area(member.shape); size > largest) {
      largest = size;
      part = member.side > 0 ? solid : polygons_[member.polygon].part;
    }
  if (largest < 1e-6 * extent) part = part_by_ray(shape);
  if (part == unknown) return false;
  if (part == solid) return true;

  // A fan from the point on most faces.
  int faces_of[Polytope::most_points] = {};
  for (int f = 0; f < shape.faces; ++f)
    for (int i = 0; i < shape.count[f]; ++i) ++faces_of[shape.corner[f][i]];
  const int apex = static_cast<int>(std::max_element(faces_of, faces_of + shape.points) - faces_of);
  for (int f = 0; f < shape.faces; ++f) {
    const auto begin = shape.corner[f].begin(), end = begin + shape.count[f];
    if (std::find(begin, end, apex) != end) continue;
    for (int i = 1; i + 1 < shape.count[f]; ++i) {
      const std::array<Point<3>, 4> x{shape.x[apex], shape.x[begin[0]], shape.x[begin[i]],
                                      shape.x[begin[i + 1]]};
      if ((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) != 0) simplices_.push_back({part, x});
    }
  }
  return true;
}

} // namespace undula::geometry
