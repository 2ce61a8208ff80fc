// What every cut must satisfy (reference numbers, section 2), computed apart from the cut: polygons clipped
// in long double, moments by Green's theorem.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "cut_summary.hpp"
#include "geometry/cut/cut.hpp"
#include "geometry/mesh/box_grid.hpp"

namespace undula::geometry::test {

using Mesh = SimplexMesh<2>;
using Polygon = std::vector<std::array<long double, 2>>;
using Solids = std::vector<Mesh>;

/// n x m squares of the box, each split in two triangles; tags 0..3 = left, right, bottom, top.
inline Mesh box_mesh(double x0, double y0, double x1, double y1, int n, int m) {
  Mesh mesh;
  mesh.boundary_names = {"left", "right", "bottom", "top"};
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.emplace_back(x0 + (x1 - x0) * i / n, y0 + (y1 - y0) * j / m);
  const auto id = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.cells.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.cells.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  for (int j = 0; j < m; ++j) {
    mesh.boundary.push_back({{id(0, j), id(0, j + 1)}, 0});
    mesh.boundary.push_back({{id(n, j), id(n, j + 1)}, 1});
  }
  for (int i = 0; i < n; ++i) {
    mesh.boundary.push_back({{id(i, 0), id(i + 1, 0)}, 2});
    mesh.boundary.push_back({{id(i, m), id(i + 1, m)}, 3});
  }
  return mesh;
}

inline Mesh moved(Mesh mesh, const Point<2>& shift, double angle = 0, double scale = 1) {
  for (auto& p : mesh.points) {
    const Point<2> rotated(std::cos(angle) * p[0] - std::sin(angle) * p[1],
                           std::sin(angle) * p[0] + std::cos(angle) * p[1]);
    p = scale * rotated + shift;
  }
  return mesh;
}

inline Polygon cell_polygon(const Mesh& mesh, int cell) {
  Polygon polygon;
  for (const int p : mesh.cells[cell]) polygon.push_back({mesh.points[p][0], mesh.points[p][1]});
  return polygon;
}

/// Sutherland-Hodgman: `subject` inside the convex, positively oriented `window`.
inline Polygon clipped(Polygon subject, const Polygon& window) {
  for (std::size_t e = 0; e < window.size() && !subject.empty(); ++e) {
    const auto& a = window[e];
    const auto& b = window[(e + 1) % window.size()];
    const auto excess = [&](const auto& p) {
      return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    };
    Polygon kept;
    for (std::size_t i = 0; i < subject.size(); ++i) {
      const auto& p = subject[i];
      const auto& q = subject[(i + 1) % subject.size()];
      const long double sp = excess(p);
      const long double sq = excess(q);
      if (sp >= 0) kept.push_back(p);
      if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) {
        const long double t = sp / (sp - sq);
        kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
      }
    }
    subject = std::move(kept);
  }
  return subject;
}

template <class Real>
Real power(Real x, int n) {
  Real product = 1;
  for (; n > 0; --n) product *= x;
  return product;
}

/// Integral of x^a y^b over the polygon (Green's theorem, 4-point Gauss rule on the edges: a + b <= 6).
inline long double moment(const Polygon& polygon, int a, int b) {
  const long double t[2] = {0.339981043584856264802665759103L, 0.861136311594052575223946488893L};
  const long double w[2] = {0.652145154862546142626936050778L, 0.347854845137453857373063949222L};
  long double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& p = polygon[i];
    const auto& q = polygon[(i + 1) % polygon.size()];
    for (int k = 0; k < 4; ++k) {
      const long double s = 0.5L * (1 + (k % 2 ? -1 : 1) * t[k / 2]);
      const long double x = p[0] + s * (q[0] - p[0]);
      const long double y = p[1] + s * (q[1] - p[1]);
      sum += 0.5L * w[k / 2] * power(x, a + 1) / (a + 1) * power(y, b) * (q[1] - p[1]);
    }
  }
  return sum;
}

/// Moments up to degree 3 of every element: parts + solid = element, relative to the element.
inline void expect_moments(const CutMesh<2>& cut, const Solids& solids, double tolerance) {
  for (int cell = 0; cell < static_cast<int>(cut.mesh.cells.size()); ++cell) {
    const auto shift = cut.mesh.points[cut.mesh.cells[cell][0]];
    const long double scale = cell_diameter(cut.mesh, cell);
    const auto local = [&](Polygon polygon) {
      for (auto& p : polygon)
        for (int i : {0, 1}) p[i] = (p[i] - shift[i]) / scale;
      return polygon;
    };
    const Polygon element = cell_polygon(cut.mesh, cell);
    const auto box = cell_box(cut.mesh, cell);
    std::vector<Polygon> covered;
    for (const auto& solid : solids)
      for (int c = 0; c < static_cast<int>(solid.cells.size()); ++c)
        if (!box.touches(cell_box(solid, c))) {
          continue;
        } else if (auto overlap = clipped(element, cell_polygon(solid, c)); !overlap.empty())
          covered.push_back(local(std::move(overlap)));
    if (covered.empty() && cut.cell_parts[cell + 1] == cut.cell_parts[cell] + 1 &&
        !cut.parts[cut.cell_parts[cell]].cut)
      continue; // away from solids
    const Polygon whole = local(element);
    for (int a = 0; a <= 3; ++a) {
      for (int b = 0; a + b <= 3; ++b) {
        long double sum = 0;
        for (const auto& polygon : covered) sum += moment(polygon, a, b);
        for (int p = cut.cell_parts[cell]; p < cut.cell_parts[cell + 1]; ++p) {
          const auto& part = cut.parts[p];
          if (!part.cut) {
            sum += moment(whole, a, b);
            EXPECT_EQ(part.quadrature_begin, part.quadrature_end);
          }
          for (int q = part.quadrature_begin; q < part.quadrature_end; ++q) {
            const auto& x = cut.volume_quadrature.points[q];
            EXPECT_GE(cut.volume_quadrature.weights[q], 0);
            sum += cut.volume_quadrature.weights[q] / (scale * scale) * power((x[0] - shift[0]) / scale, a) *
                   power((x[1] - shift[1]) / scale, b);
          }
        }
        ASSERT_NEAR(static_cast<double>(sum), static_cast<double>(moment(whole, a, b)),
                    tolerance * static_cast<double>(moment(whole, 0, 0)))
            << "cell " << cell << ", monomial x^" << a << " y^" << b;
      }
    }
  }
}

/// Every part is closed (integral of n = 0) and its measure is half the integral of x . n.
inline void expect_closed(const CutMesh<2>& cut, double tolerance) {
  struct Sums {
    Point<2> normal = Point<2>::Zero();
    double flux = 0;
  };
  std::vector<Sums> sums(cut.parts.size());
  const auto add = [&](int part, const Point<2>& normal, double measure, const Point<2>& on_it) {
    const auto& origin = cut.mesh.points[cut.mesh.cells[cut.parts[part].cell][0]];
    sums[part].normal += measure * normal;
    sums[part].flux += measure * normal.dot(on_it - origin);
  };
  const auto add_facet = [&](int part, const Facet<2>& facet, int k, double measure) {
    const Point<2> outward =
        -barycentric_gradients(cut.mesh, facet.cells[k]).col(facet.local[k]).normalized();
    add(part, outward, measure, cut.mesh.points[facet.points[0]]);
  };
  for (const auto& piece : cut.interface)
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
      add(piece.part, piece.normal, cut.interface_quadrature.weights[q], cut.interface_quadrature.points[q]);
  for (const auto& piece : cut.boundary)
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
      add_facet(piece.part, cut.facets.facets[piece.facet], 0, cut.boundary_quadrature.weights[q]);
  for (const auto& connection : cut.connections)
    for (int k : {0, 1})
      add_facet(connection.part[k], cut.facets.facets[connection.facet], k, connection.measure);
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const double h = cell_diameter(cut.mesh, cut.parts[p].cell);
    ASSERT_LE(sums[p].normal.norm(), tolerance * h) << "part " << p << " is not closed";
    ASSERT_NEAR(sums[p].flux / 2, cut.parts[p].measure, tolerance * h * h) << "part " << p;
  }
}

/// Unknowns of the parts below and above the height y; `unknowns`: by part.
template <class ByPart>
std::array<std::set<int>, 2> sides_of(const CutMesh<2>& cut, const ByPart& unknowns, double y) {
  std::array<std::set<int>, 2> sides;
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& part = cut.parts[p];
    const double at = part.cut ? cut.volume_quadrature.points[part.quadrature_begin][1]
                               : cut.mesh.points[cut.mesh.cells[part.cell][1]][1];
    sides[at < y ? 0 : 1].insert(unknowns[p].begin(), unknowns[p].end());
  }
  return sides;
}

/// Length of the skin of the solids inside the box [x0, x1] x [y0, y1].
inline double skin_in_box(const Solids& solids, double x0, double y0, double x1, double y1) {
  double length = 0;
  for (const auto& solid : solids) {
    for (const auto& facet : build_facet_table(solid).facets) {
      if (facet.cells[1] >= 0) continue;
      const auto& p = solid.points[facet.points[0]];
      const auto& q = solid.points[facet.points[1]];
      double from = 0;
      double to = 1;
      const double low[2] = {x0, y0};
      const double high[2] = {x1, y1};
      for (int i : {0, 1}) {
        const double step = q[i] - p[i];
        if (step == 0) {
          if (p[i] < low[i] || p[i] > high[i]) to = from;
          continue;
        }
        from = std::max(from, std::min((low[i] - p[i]) / step, (high[i] - p[i]) / step));
        to = std::min(to, std::max((low[i] - p[i]) / step, (high[i] - p[i]) / step));
      }
      length += std::max(0.0, to - from) * (q - p).norm();
    }
  }
  return length;
}

} // namespace undula::geometry::test
