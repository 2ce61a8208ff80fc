// What every cut in space must satisfy, computed apart from the cut: tetrahedra clipped in long double.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "cut_summary.hpp"
#include "geometry/cut/cut.hpp"
#include "geometry/mesh/box_mesh.hpp"

namespace undula::geometry::test {

using Mesh3 = SimplexMesh<3>;
using Solids3 = std::vector<Mesh3>;
using LongPoint = Eigen::Matrix<long double, 3, 1>;
using Tetrahedron = std::array<LongPoint, 4>;

inline Mesh3 moved(Mesh3 mesh, const Point<3>& shift,
                   const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity(), double scale = 1) {
  for (auto& p : mesh.points) p = scale * (turn * p) + shift;
  return mesh;
}

/// Appends what of a tetrahedron lies where the excess, linear with these values at its corners, is positive.
inline void append_positive(const Tetrahedron& t, const std::array<long double, 4>& excess,
                            std::vector<Tetrahedron>& pieces) {
  std::vector<int> in, out;
  for (int i = 0; i < 4; ++i) (excess[i] > 0 ? in : out).push_back(i);
  const auto on = [&](int i, int j) -> LongPoint {
    return t[i] + excess[i] / (excess[i] - excess[j]) * (t[j] - t[i]);
  };
  if (in.size() == 4) pieces.push_back(t);
  if (in.size() == 1) pieces.push_back({t[in[0]], on(in[0], out[0]), on(in[0], out[1]), on(in[0], out[2])});
  // Prisms, from the triangle p0 p1 p2 to q0 q1 q2.
  const auto prism = [&](const std::array<LongPoint, 3>& p, const std::array<LongPoint, 3>& q) {
    pieces.push_back({p[0], p[1], p[2], q[0]});
    pieces.push_back({p[1], p[2], q[0], q[1]});
    pieces.push_back({p[2], q[0], q[1], q[2]});
  };
  if (in.size() == 2)
    prism({t[in[0]], on(in[0], out[0]), on(in[0], out[1])}, {t[in[1]], on(in[1], out[0]), on(in[1], out[1])});
  if (in.size() == 3)
    prism({t[in[0]], t[in[1]], t[in[2]]}, {on(in[0], out[0]), on(in[1], out[0]), on(in[2], out[0])});
}

inline Tetrahedron corners(const Mesh3& mesh, int cell) {
  Tetrahedron t;
  for (int i = 0; i < 4; ++i) t[i] = mesh.points[mesh.cells[cell][i]].cast<long double>();
  return t;
}

/// What two positive tetrahedra share.
inline std::vector<Tetrahedron> shared(const Tetrahedron& a, const Tetrahedron& b) {
  std::vector<Tetrahedron> pieces{a};
  constexpr int facets[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  for (const auto& f : facets) {
    const LongPoint normal = (b[f[1]] - b[f[0]]).cross(b[f[2]] - b[f[0]]);
    std::vector<Tetrahedron> kept;
    for (const auto& piece : pieces) {
      std::array<long double, 4> excess;
      for (int i = 0; i < 4; ++i) excess[i] = normal.dot(piece[i] - b[f[0]]);
      append_positive(piece, excess, kept);
    }
    pieces = std::move(kept);
  }
  return pieces;
}

/// Integrals of 1, x, y, z, xx, xy, xz, yy, yz, zz over a tetrahedron.
using Moments = std::array<long double, 10>;
inline void add_moments(const Tetrahedron& t, Moments& sum) {
  const long double volume = std::abs((t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0])) / 6;
  const LongPoint total = t[0] + t[1] + t[2] + t[3];
  sum[0] += volume;
  int k = 4;
  for (int i = 0; i < 3; ++i) {
    sum[1 + i] += volume * total[i] / 4;
    for (int j = i; j < 3; ++j) {
      long double products = total[i] * total[j];
      for (const auto& x : t) products += x[i] * x[j];
      sum[k++] += volume * products / 20;
    }
  }
}

/// Moments up to degree 2 of every element: parts + solid = element, relative to the element.
inline void expect_moments(const CutMesh<3>& cut, const Solids3& solids, double tolerance) {
  std::vector<Box<3>> boxes;
  std::vector<SolidCell> all;
  for (int s = 0; s < static_cast<int>(solids.size()); ++s)
    for (int c = 0; c < static_cast<int>(solids[s].cells.size()); ++c) {
      all.push_back({s, c});
      boxes.push_back(cell_box(solids[s], c));
    }
  const BoxGrid<3> grid(boxes);
  for (int cell = 0; cell < static_cast<int>(cut.mesh.cells.size()); ++cell) {
    const LongPoint origin = cut.mesh.points[cut.mesh.cells[cell][0]].cast<long double>();
    const long double scale = cell_diameter(cut.mesh, cell);
    const auto local = [&](Tetrahedron t) {
      for (auto& x : t) x = (x - origin) / scale;
      return t;
    };
    const auto element = corners(cut.mesh, cell);
    Moments sum{}, whole{};
    add_moments(local(element), whole);
    for (const int i : grid.touching(cell_box(cut.mesh, cell)))
      for (const auto& piece : shared(element, corners(solids[all[i].solid], all[i].cell)))
        add_moments(local(piece), sum);
    for (int p = cut.cell_parts[cell]; p < cut.cell_parts[cell + 1]; ++p) {
      const auto& part = cut.parts[p];
      if (!part.cut) {
        for (int k = 0; k < 10; ++k) sum[k] += whole[k];
        EXPECT_EQ(part.quadrature_begin, part.quadrature_end);
      }
      for (int q = part.quadrature_begin; q < part.quadrature_end; ++q) {
        const LongPoint x = (cut.volume_quadrature.points[q].cast<long double>() - origin) / scale;
        const long double w = cut.volume_quadrature.weights[q] / (scale * scale * scale);
        EXPECT_GE(w, 0);
        sum[0] += w;
        int k = 4;
        for (int i = 0; i < 3; ++i) {
          sum[1 + i] += w * x[i];
          for (int j = i; j < 3; ++j) sum[k++] += w * x[i] * x[j];
        }
      }
    }
    for (int k = 0; k < 10; ++k)
      ASSERT_NEAR(static_cast<double>(sum[k]), static_cast<double>(whole[k]),
                  tolerance * static_cast<double>(whole[0]))
          << "cell " << cell << ", moment " << k;
  }
}

/// Every part is closed (integral of n = 0), its measure is a third of the integral of x . n, and the first
/// moments of all the fluid are the integrals of x_i^2 n_i / 2.
inline void expect_closed(const CutMesh<3>& cut, double tolerance) {
  std::vector<Point<3>> normals(cut.parts.size(), Point<3>::Zero());
  std::vector<double> fluxes(cut.parts.size(), 0);
  const auto add = [&](int part, const Point<3>& normal, double measure, const Point<3>& on_it) {
    const auto& origin = cut.mesh.points[cut.mesh.cells[cut.parts[part].cell][0]];
    normals[part] += measure * normal;
    fluxes[part] += measure * normal.dot(on_it - origin);
  };
  const auto outward = [&](const Facet<3>& facet, int k) -> Point<3> {
    return -barycentric_gradients(cut.mesh, facet.cells[k]).col(facet.local[k]).normalized();
  };
  const auto box = box_around(cut.mesh.points);
  const Point<3> middle = (box.low + box.high) / 2;
  const double size = (box.high - box.low).norm();
  Point<3> surface = Point<3>::Zero(), volume = Point<3>::Zero();
  const auto add_square = [&](const Point<3>& x, double weight, const Point<3>& normal) {
    surface += weight / 2 * (x - middle).cwiseAbs2().cwiseProduct(normal);
  };
  for (const auto& piece : cut.interface) {
    EXPECT_NEAR(piece.normal.norm(), 1, 1e-13);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      EXPECT_GE(cut.interface_quadrature.weights[q], 0);
      add(piece.part, piece.normal, cut.interface_quadrature.weights[q], cut.interface_quadrature.points[q]);
      add_square(cut.interface_quadrature.points[q], cut.interface_quadrature.weights[q], piece.normal);
    }
  }
  for (const auto& piece : cut.boundary) {
    const auto& facet = cut.facets.facets[piece.facet];
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      add(piece.part, outward(facet, 0), cut.boundary_quadrature.weights[q],
          cut.mesh.points[facet.points[0]]);
      add_square(cut.boundary_quadrature.points[q], cut.boundary_quadrature.weights[q], outward(facet, 0));
    }
  }
  for (const auto& connection : cut.connections) {
    EXPECT_GE(connection.measure, 0);
    const auto& facet = cut.facets.facets[connection.facet];
    for (int k : {0, 1})
      add(connection.part[k], outward(facet, k), connection.measure, cut.mesh.points[facet.points[0]]);
  }
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& part = cut.parts[p];
    const double h = cell_diameter(cut.mesh, part.cell);
    EXPECT_GE(part.measure, 0);
    EXPECT_EQ(part.cut, part.simplex_end > part.simplex_begin);
    ASSERT_LE(normals[p].norm(), tolerance * h * h) << "part " << p << " is not closed";
    ASSERT_NEAR(fluxes[p] / 3, part.measure, tolerance * h * h * h) << "part " << p;
    if (!part.cut)
      for (const int v : cut.mesh.cells[part.cell])
        volume += part.measure / 4 * (cut.mesh.points[v] - middle);
    for (int q = part.quadrature_begin; q < part.quadrature_end; ++q)
      volume += cut.volume_quadrature.weights[q] * (cut.volume_quadrature.points[q] - middle);
  }
  ASSERT_LE((surface - volume).norm(), tolerance * std::pow(size, 4));
}

} // namespace undula::geometry::test
