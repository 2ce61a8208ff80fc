// What CGAL's refinement in space leaves, as a mesh. Only for files that include CGAL's Mesh_3.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "geometry/mesh/space_mesh.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {

/// Of a regular tetrahedron with edges of about one: the radii of the balls around its cell and its facets,
/// which refinement bounds. Edges of the finished mesh then scatter about the target.
inline constexpr double cell_radius = 0.7;
inline constexpr double facet_radius = 0.65;
/// Distance of the surface from its facets, in target lengths.
inline constexpr double surface_distance = 0.1;

/// The target times a factor, as CGAL asks for it.
template <class Domain>
struct ScaledSize {
  using FT = double;
  using Point_3 = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Index = typename Domain::Index;
  const SpaceSizeField* size;
  double factor;
  double operator()(const Point_3& x, const int, const Index&) const {
    return factor * (*size)(Point<3>(x.x(), x.y(), x.z()));
  }
};

/// Refines, then moves points (odt, perturb), which takes flat cells away. Exudation does so too, but its
/// result depends on where CGAL's objects lie in memory. Throws InputError beyond `most_points`.
template <class Complex, class Domain, class Criteria>
Complex refined_complex(const Domain& domain, const Criteria& criteria, int most_points,
                        const std::string& where) {
  using namespace CGAL::parameters;
  auto complex = CGAL::make_mesh_3<Complex>(
      domain, criteria, no_perturb(), no_exude(),
      mesh_3_options(maximal_number_of_vertices = static_cast<std::size_t>(most_points)));
  if (complex.triangulation().number_of_vertices() >= static_cast<std::size_t>(most_points))
    throw InputError("a mesh would have too many points", "more than " + std::to_string(most_points),
                     "a coarser size", where);
  CGAL::odt_optimize_mesh_3(complex, domain, max_iteration_number = 10);
  CGAL::perturb_mesh_3(complex, domain);
  return complex;
}

/// Points along a Hilbert curve, cells by their first point; no boundary.
template <class Complex>
SimplexMesh<3> refined_cells(const Complex& complex) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell)
    for (int i = 0; i < 4; ++i) points.push_back(cell->vertex(i)->point().point());
  // Sorted by coordinates first: the curve then depends on the set of points only.
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  CGAL::hilbert_sort(points.begin(), points.end(), Kernel());
  std::map<Kernel::Point_3, int> number;
  SimplexMesh<3> mesh;
  for (const auto& x : points) {
    number.emplace(x, static_cast<int>(mesh.points.size()));
    mesh.points.emplace_back(x.x(), x.y(), x.z());
  }
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    std::array<int, 4> v;
    for (int i = 0; i < 4; ++i) v[i] = number.at(cell->vertex(i)->point().point());
    // Even permutations: the lowest point first, then the lowest of the others.
    const auto lowest = std::min_element(v.begin(), v.end()) - v.begin();
    if (lowest != 0) {
      std::swap(v[0], v[lowest]);
      std::swap(v[lowest == 1 ? 2 : 1], v[lowest == 3 ? 2 : 3]);
    }
    std::rotate(v.begin() + 1, std::min_element(v.begin() + 1, v.end()), v.end());
    mesh.cells.push_back(v);
  }
  std::sort(mesh.cells.begin(), mesh.cells.end());
  return mesh;
}

/// Takes away cells that lie flat in the boundary, with two facets on it: refinement leaves some.
void peel_flat_cells(SimplexMesh<3>& mesh);

} // namespace undula::geometry
