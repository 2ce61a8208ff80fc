// The channel of the DFG benchmarks (Schaefer & Turek 1996): 2.2 x 0.41, cylinder of radius 0.05 about (0.2,
// 0.2), density 1, viscosity 0.001.
#pragma once

#include "fom/problem/problem.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::verification {

inline constexpr double channel_length = 2.2, channel_height = 0.41, cylinder_radius = 0.05;
inline const Point<2> cylinder_centre(0.2, 0.2);

/// Ascending coordinates from `low` to `high` whose spacing grows from `first` by the factor `growth` up to
/// `limit`.
inline std::vector<double> graded(double low, double high, double first, double growth, double limit) {
  std::vector<double> x{low};
  for (double step = first; x.back() < high; step = std::min(step * growth, limit))
    x.push_back(x.back() + step);
  for (auto& value : x) value = low + (value - low) * (high - low) / (x.back() - low);
  x.back() = high;
  return x;
}

/// Mesh fitted to the cylinder, a polygon of 4 * `side` corners: rings from the circle to the square
/// [0, 0.41]^2, then a tensor mesh to the outlet. The rings' spacing starts at `first` and grows to the
/// square's.
inline SimplexMesh<2> fitted_cylinder_mesh(int side, double first) {
  SimplexMesh<2> mesh;
  const double size = channel_height / side;
  // Points of the square, counter-clockwise from its lower right corner, and the rays to them.
  std::vector<Point<2>> outer;
  const Point<2> corners[] = {
      {channel_height, 0}, {channel_height, channel_height}, {0, channel_height}, {0, 0}};
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < side; ++i)
      outer.push_back(corners[k] + (corners[(k + 1) % 4] - corners[k]) * (static_cast<double>(i) / side));
  const int around = static_cast<int>(outer.size());
  const auto radial =
      graded(0, 1, first / 0.155, 1.12, 1.0 * size / 0.155); // 0.155: from the circle to a side
  const int rings = static_cast<int>(radial.size());
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const double angle = (static_cast<double>(k) / around - 0.125) * 2 * std::numbers::pi;
      const Point<2> inner = cylinder_centre + cylinder_radius * Point<2>(std::cos(angle), std::sin(angle));
      mesh.points.push_back(ring == rings - 1 ? outer[k]
                                              : Point<2>(inner + radial[ring] * (outer[k] - inner)));
    }
  const auto split = [&](int a, int b, int c, int d, bool flip) { // quadrilateral, counter-clockwise
    if (flip) {
      mesh.cells.push_back({a, b, d});
      mesh.cells.push_back({b, c, d});
    } else {
      mesh.cells.push_back({a, b, c});
      mesh.cells.push_back({a, c, d});
    }
  };
  const auto ring_point = [&](int ring, int k) { return ring * around + k % around; };
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int k = 0; k < around; ++k)
      split(ring_point(ring, k), ring_point(ring + 1, k), ring_point(ring + 1, k + 1),
            ring_point(ring, k + 1), (ring + k) % 2 == 0);

  mesh.boundary_names = {"cylinder", "wall", "inlet", "outlet"};
  for (int k = 0; k < around; ++k) {
    mesh.boundary.push_back({{ring_point(0, k), ring_point(0, k + 1)}, 0});
    const int which = k / side; // the first side is where the rest of the channel begins
    if (which != 0)
      mesh.boundary.push_back({{ring_point(rings - 1, k), ring_point(rings - 1, k + 1)}, which == 2 ? 2 : 1});
  }
  const auto along = graded(channel_height, channel_length, size, 1.03, 2.5 * size);
  const int columns = static_cast<int>(along.size());
  const int base = static_cast<int>(mesh.points.size());
  const auto channel_point = [&](int column, int row) {
    return column == 0 ? ring_point(rings - 1, row) : base + (column - 1) * (side + 1) + row;
  };
  for (int column = 1; column < columns; ++column)
    for (int row = 0; row <= side; ++row)
      mesh.points.emplace_back(along[column], outer[0][1] + channel_height * row / side);
  for (int column = 0; column + 1 < columns; ++column) {
    for (int row = 0; row < side; ++row)
      split(channel_point(column, row), channel_point(column + 1, row), channel_point(column + 1, row + 1),
            channel_point(column, row + 1), (column + row) % 2 == 0);
    for (const int row : {0, side})
      mesh.boundary.push_back({{channel_point(column, row), channel_point(column + 1, row)}, 1});
  }
  for (int row = 0; row < side; ++row)
    mesh.boundary.push_back({{channel_point(columns - 1, row), channel_point(columns - 1, row + 1)}, 3});
  return mesh;
}

/// Tensor mesh of the whole channel, finest (`fine`) around the cylinder, which is left out of it.
inline SimplexMesh<2> channel_background(double fine, double coarse) {
  const auto axis = [&](double low, double high, double from, double to) {
    // Even spacing across the cylinder, growing away from it.
    std::vector<double> x;
    for (const double distance : graded(0, from - low, fine, 1.1, coarse))
      x.insert(x.begin(), from - distance);
    for (const double value : spaced(from, to, static_cast<int>(std::ceil((to - from) / fine))))
      if (value > x.back()) x.push_back(value);
    for (const double distance : graded(0, high - to, fine, 1.1, coarse))
      if (distance > 0) x.push_back(to + distance);
    x.front() = low;
    x.back() = high;
    return x;
  };
  return tensor_mesh(axis(0, channel_length, 0.13, 0.3), axis(0, channel_height, 0.13, 0.27),
                     {"inlet", "outlet", "wall", "wall_above"});
}

/// The disc as a polygon of `around` corners, in `rings` layers around its centre.
inline SimplexMesh<2> cylinder_mesh(int around, int rings) {
  SimplexMesh<2> mesh;
  mesh.points.push_back(cylinder_centre);
  for (int ring = 1; ring <= rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const double angle = (k + 0.25) * 2 * std::numbers::pi / around; // off the lines of the background
      mesh.points.push_back(cylinder_centre +
                            cylinder_radius * ring / rings * Point<2>(std::cos(angle), std::sin(angle)));
    }
  const auto at = [&](int ring, int k) { return 1 + (ring - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) {
    mesh.cells.push_back({0, at(1, k), at(1, k + 1)});
    for (int ring = 1; ring < rings; ++ring) {
      mesh.cells.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      mesh.cells.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
    mesh.boundary.push_back({{at(rings, k), at(rings, k + 1)}, 0});
  }
  mesh.boundary_names = {"skin"};
  return mesh;
}

/// Parabolic inflow of the given mean velocity; the outlet carries no normal stress.
inline FsiProblem<2> cylinder_problem(SimplexMesh<2> background, double mean_velocity,
                                      const StabilisationWeights& weights) {
  using Kind = BoundaryCondition<2>::Kind;
  FsiProblem<2> problem;
  problem.fluid = {1.0, 1e-3};
  problem.background = std::move(background);
  problem.stabilisation = weights;
  for (const auto& name : problem.background.boundary_names) problem.boundary[name].kind = Kind::velocity;
  problem.boundary["inlet"].velocity = [mean_velocity](const Point<2>& x, double) -> Point<2> {
    return {6 * mean_velocity * x[1] * (channel_height - x[1]) / (channel_height * channel_height), 0};
  };
  problem.boundary["outlet"].kind = Kind::opening;
  problem.boundary["outlet"].opening = OpeningCondition::traction;
  return problem;
}

/// 2 F / (density U^2 D), with U the mean inflow velocity.
inline Point<2> force_coefficients(const Point<2>& force, double mean_velocity) {
  return force / (mean_velocity * mean_velocity * cylinder_radius);
}

} // namespace undula::verification
