#include "geometry/mesh/overlap_volume.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

namespace undula::geometry {
namespace {

using Tetrahedron = std::array<Point<3>, 4>;

// Appends the part of a tetrahedron where a linear function with these values at its corners is positive.
void append_positive(const Tetrahedron& x, const std::array<double, 4>& value,
                     std::vector<Tetrahedron>& pieces) {
  std::array<int, 4> order{}; // the corners inside first
  int inside = 0, outside = 4;
  for (int i = 0; i < 4; ++i) order[value[i] > 0 ? inside++ : --outside] = i;
  const auto crossing = [&](int i, int j) -> Point<3> {
    const int p = order[i], q = order[j];
    return x[p] + value[p] / (value[p] - value[q]) * (x[q] - x[p]);
  };
  const auto corner = [&](int i) -> const Point<3>& { return x[order[i]]; };
  const auto add_prism = [&](const std::array<Point<3>, 3>& p, const std::array<Point<3>, 3>& q) {
    pieces.push_back({p[0], p[1], p[2], q[2]});
    pieces.push_back({p[0], p[1], q[1], q[2]});
    pieces.push_back({p[0], q[0], q[1], q[2]});
  };
  if (inside == 4) pieces.push_back(x);
  if (inside == 1) pieces.push_back({corner(0), crossing(0, 1), crossing(0, 2), crossing(0, 3)});
  if (inside == 2)
    add_prism({corner(0), crossing(0, 2), crossing(0, 3)}, {corner(1), crossing(1, 2), crossing(1, 3)});
  if (inside == 3)
    add_prism({corner(0), corner(1), corner(2)}, {crossing(0, 3), crossing(1, 3), crossing(2, 3)});
}

} // namespace

double overlap_volume(const Tetrahedron& a, const Tetrahedron& b) {
  constexpr int facets[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}; // seen from the fourth corner
  std::vector<Tetrahedron> pieces{a}, kept;
  for (const auto& f : facets) {
    const Point<3> inward = (b[f[1]] - b[f[0]]).cross(b[f[2]] - b[f[0]]);
    kept.clear();
    for (const auto& piece : pieces) {
      std::array<double, 4> value;
      for (int i = 0; i < 4; ++i) value[i] = inward.dot(piece[i] - b[f[0]]);
      append_positive(piece, value, kept);
    }
    std::swap(pieces, kept);
  }
  double volume = 0;
  for (const auto& x : pieces) volume += std::abs((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0])) / 6;
  return volume;
}

} // namespace undula::geometry
