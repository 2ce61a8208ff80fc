// What two cuts are compared by, whatever the space.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "geometry/cut/cut.hpp"

namespace undula::geometry::test {

/// Random numbers that are the same on every machine.
class Fuzz {
public:
  explicit Fuzz(int seed) : random_(static_cast<unsigned>(seed)) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  int integer(int low, int high) { return low + static_cast<int>(random_() % (high - low + 1)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

private:
  std::mt19937 random_;
};

/// Measures and combinatorics of a cut.
struct CutSummary {
  std::size_t parts = 0, cut_parts = 0, connections = 0, boundary_pieces = 0, unknowns = 0, edge_unknowns = 0;
  double volume = 0, interface = 0, boundary = 0;
};

template <int dim>
CutSummary summary(const CutMesh<dim>& cut) {
  CutSummary s;
  s.parts = cut.parts.size();
  s.connections = cut.connections.size();
  s.boundary_pieces = cut.boundary.size();
  for (const auto& part : cut.parts) {
    s.cut_parts += part.cut;
    s.volume += part.measure;
  }
  for (const double w : cut.interface_quadrature.weights) s.interface += w;
  for (const double w : cut.boundary_quadrature.weights) s.boundary += w;
  s.unknowns = build_dof_sets(cut).dof_point.size();
  s.edge_unknowns = build_edge_sets(cut).edge_points.size();
  return s;
}

/// The same but for the order of things: numbers, and measures to `tolerance`.
inline void expect_same_numbers(const CutSummary& after, const CutSummary& before, double tolerance) {
  EXPECT_EQ(after.parts, before.parts);
  EXPECT_EQ(after.cut_parts, before.cut_parts);
  EXPECT_EQ(after.connections, before.connections);
  EXPECT_EQ(after.boundary_pieces, before.boundary_pieces);
  EXPECT_EQ(after.unknowns, before.unknowns);
  EXPECT_EQ(after.edge_unknowns, before.edge_unknowns);
  EXPECT_NEAR(after.volume, before.volume, tolerance);
  EXPECT_NEAR(after.interface, before.interface, tolerance);
}

/// The same mesh with points and cells in another order, and each cell begun at another of its points.
template <int dim>
void renumber(SimplexMesh<dim>& mesh, std::mt19937& random) {
  std::vector<int> to(mesh.points.size());
  std::iota(to.begin(), to.end(), 0);
  std::shuffle(to.begin(), to.end(), random);
  auto points = mesh.points;
  for (std::size_t i = 0; i < to.size(); ++i) points[to[i]] = mesh.points[i];
  mesh.points = points;
  for (auto& cell : mesh.cells) {
    for (int& p : cell) p = to[p];
    std::rotate(cell.begin(), cell.begin() + random() % 3, cell.begin() + 3); // an even permutation
  }
  for (auto& facet : mesh.boundary)
    for (int& p : facet.points) p = to[p];
  std::shuffle(mesh.cells.begin(), mesh.cells.end(), random);
}

/// Connections across the same facets, as many and as large.
template <int dim>
void expect_same_facets(const CutMesh<dim>& a, const CutMesh<dim>& b, double tolerance) {
  const auto by_facet = [](const auto& cut) {
    std::map<int, std::vector<double>> facets;
    for (const auto& connection : cut.connections) facets[connection.facet].push_back(connection.measure);
    for (auto& [facet, measures] : facets) std::sort(measures.begin(), measures.end());
    return facets;
  };
  const auto facets_a = by_facet(a), facets_b = by_facet(b);
  ASSERT_EQ(facets_a.size(), facets_b.size());
  for (auto i = facets_a.begin(), j = facets_b.begin(); i != facets_a.end(); ++i, ++j) {
    ASSERT_EQ(i->first, j->first);
    ASSERT_EQ(i->second.size(), j->second.size()) << "connections across facet " << i->first;
    for (std::size_t k = 0; k < i->second.size(); ++k)
      ASSERT_NEAR(i->second[k], j->second[k], tolerance) << "facet " << i->first;
  }
}

} // namespace undula::geometry::test
