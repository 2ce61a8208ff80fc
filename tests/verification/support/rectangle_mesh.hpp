// Structured triangulations of rectangles and of the discs and boxes that the tests immerse.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// Names of the four sides of a rectangle.
struct SideNames {
  std::string left = "left", right = "right", bottom = "bottom", top = "top";
};

/// Tensor-product mesh on the given ascending coordinates; every quadrilateral is split along the diagonal
/// that alternates from one to the next, so that no direction is preferred.
inline SimplexMesh<2> tensor_mesh(const std::vector<double>& x, const std::vector<double>& y,
                                  const SideNames& names = {}) {
  SimplexMesh<2> mesh;
  const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
  const auto at = [&](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.points.emplace_back(x[i], y[j]);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.cells.push_back({a, b, c});
        mesh.cells.push_back({a, c, d});
      } else {
        mesh.cells.push_back({a, b, d});
        mesh.cells.push_back({b, c, d});
      }
    }
  mesh.boundary_names = {names.left, names.right, names.bottom, names.top};
  for (int j = 0; j < ny; ++j) {
    mesh.boundary.push_back({{at(0, j), at(0, j + 1)}, 0});
    mesh.boundary.push_back({{at(nx, j), at(nx, j + 1)}, 1});
  }
  for (int i = 0; i < nx; ++i) {
    mesh.boundary.push_back({{at(i, 0), at(i + 1, 0)}, 2});
    mesh.boundary.push_back({{at(i, ny), at(i + 1, ny)}, 3});
  }
  return mesh;
}

/// n + 1 evenly spaced coordinates.
inline std::vector<double> spaced(double low, double high, int n) {
  std::vector<double> x(n + 1);
  for (int i = 0; i <= n; ++i) x[i] = low + (high - low) * i / n;
  return x;
}

/// The unit square with n x n quadrilaterals, inner points moved by a smooth field so that edges are straight
/// but no longer parallel to the axes: a mesh without symmetry.
inline SimplexMesh<2> warped_square(int n) {
  auto mesh = tensor_mesh(spaced(0, 1, n), spaced(0, 1, n));
  for (auto& point : mesh.points) {
    const double bump =
        0.03 * std::sin(2 * std::numbers::pi * point[0]) * std::sin(2 * std::numbers::pi * point[1]);
    const bool inside = (point.array() > 0).all() && (point.array() < 1).all();
    if (inside) point += Point<2>(bump, -0.7 * bump);
  }
  return mesh;
}

/// Mesh of the rectangle |X| <= half_x, |Y| <= half_y in axes turned by `angle` about `centre`.
inline SimplexMesh<2> turned_box(const Point<2>& centre, double half_x, double half_y, double angle, int nx,
                                 int ny) {
  auto mesh = tensor_mesh(spaced(-half_x, half_x, nx), spaced(-half_y, half_y, ny));
  for (auto& point : mesh.points)
    point = centre + Point<2>(std::cos(angle) * point[0] - std::sin(angle) * point[1],
                              std::sin(angle) * point[0] + std::cos(angle) * point[1]);
  return mesh;
}

} // namespace undula::verification
