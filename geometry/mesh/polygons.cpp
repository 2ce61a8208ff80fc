#include "geometry/mesh/polygons.hpp"

#include <algorithm>
#include <cmath>

namespace undula::geometry {
namespace {

double cross(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

} // namespace

std::vector<Segment<2>> polygon_sides(const std::vector<Point<2>>& polygon) {
  std::vector<Segment<2>> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sides.push_back({polygon[i], polygon[(i + 1) % polygon.size()]});
  return sides;
}

bool inside_outline(std::span<const Segment<2>> sides, const Point<2>& x) {
  bool odd = false;
  for (const auto& [a, b] : sides)
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      odd = !odd;
  return odd;
}

double polygon_area(const std::vector<Point<2>>& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) twice += cross(polygon[0], polygon[i], polygon[i + 1]);
  return twice / 2;
}

bool triangulate_polygon(const std::vector<Point<2>>& polygon,
                         std::vector<std::array<Point<2>, 3>>& triangles) {
  constexpr double closure = 1e-13; // of the square of the size: what the triangles may miss or fold
  const std::size_t begin = triangles.size();
  double size = 0;
  for (const auto& p : polygon) size = std::max(size, (p - polygon[0]).squaredNorm());
  const double area = polygon_area(polygon);
  const double rounding = 1e-15 * size;

  std::vector<int> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<int>(i);
  const auto at = [&](std::size_t i) -> const Point<2>& { return polygon[left[i % left.size()]]; };
  double sum = 0;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    // The roundest ear: largest area over the square of its longest side.
    std::size_t best = n;
    double best_shape = 0;
    bool flat = false;
    for (std::size_t i = 0; i < n && !flat; ++i) {
      const auto &a = at(i + n - 1), &b = at(i), &c = at(i + 1);
      const double twice = cross(a, b, c);
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (c - a).squaredNorm()});
      if (std::abs(twice) <= rounding) {
        // Three corners in a row on one line: the middle one goes, unless the line folds back there.
        if (n > 3 && (b - a).dot(c - b) < 0) continue;
        best = i;
        flat = true;
        continue;
      }
      const double shape = twice / longest;
      if (twice < 0 || shape <= best_shape) continue;
      bool empty = true;
      for (std::size_t j = i + 2; j < i + n - 1 && empty; ++j) {
        const auto& p = at(j);
        empty = cross(a, b, p) < 0 || cross(b, c, p) < 0 || cross(c, a, p) < 0;
      }
      if (!empty) continue;
      best = i;
      best_shape = shape;
    }
    if (best == n) break;
    const auto &a = at(best + n - 1), &b = at(best), &c = at(best + 1);
    if (const double twice = cross(a, b, c); twice != 0) {
      triangles.push_back({a, b, c});
      sum += std::abs(twice) / 2;
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (left.size() < 3 && std::abs(sum - area) <= closure * size) return true;
  triangles.resize(begin);
  return false;
}

double overlap_area(const std::array<Point<2>, 3>& a, const std::array<Point<2>, 3>& b) {
  // Sutherland and Hodgman 1974.
  std::vector<Point<2>> shared(a.begin(), a.end()), kept;
  for (int e = 0; e < 3 && !shared.empty(); ++e) {
    kept.clear();
    for (std::size_t i = 0; i < shared.size(); ++i) {
      const auto &p = shared[i], &q = shared[(i + 1) % shared.size()];
      const double at_p = cross(b[e], b[(e + 1) % 3], p), at_q = cross(b[e], b[(e + 1) % 3], q);
      if (at_p >= 0) kept.push_back(p);
      if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))
        kept.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    std::swap(shared, kept);
  }
  return shared.size() < 3 ? 0 : polygon_area(shared);
}

} // namespace undula::geometry
