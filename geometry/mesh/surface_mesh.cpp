#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>

#include "geometry/mesh/refined_cells.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

/// Edges where the surface turns by more are kept, degrees.
constexpr double sharp_angle = 30;

Surface read_surface(const std::filesystem::path& file, double cm_per_unit) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  const auto refuse = [&](const std::string& seen, const std::string& allowed) {
    throw InputError("a surface cannot be meshed", seen, allowed, file.string());
  };
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
  if (!std::filesystem::is_regular_file(file)) refuse("no such file", "a readable OFF or STL file");
  if (!CGAL::IO::read_polygon_soup(file.string(), points, triangles) || triangles.empty())
    refuse("no triangles", "a readable OFF or STL file");
  for (auto& x : points) x = {cm_per_unit * x.x(), cm_per_unit * x.y(), cm_per_unit * x.z()};
  for (const auto& triangle : triangles)
    if (triangle.size() != 3)
      refuse("a face with " + std::to_string(triangle.size()) + " corners", "triangles");
  pmp::repair_polygon_soup(points, triangles); // STL repeats its points
  if (!pmp::orient_polygon_soup(points, triangles) || !pmp::is_polygon_soup_a_polygon_mesh(triangles))
    refuse("triangles that do not go together", "a surface, each edge with two triangles");
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
  if (!CGAL::is_closed(surface)) refuse("an edge with one triangle", "a closed surface");
  if (pmp::does_self_intersect(surface))
    refuse("triangles that cross", "a surface that does not cross itself");
  pmp::orient_to_bound_a_volume(surface);
  return surface;
}

} // namespace

SimplexMesh<3> mesh_closed_surface(const std::filesystem::path& file, double cm_per_unit,
                                   const SpaceSizeField& size, int most_points) {
  const auto surface = read_surface(file, cm_per_unit);
  CGAL::Random random(0);
  CGAL::get_default_random() = CGAL::Random(0); // the result depends on the input only
  Domain domain(surface, &random);
  domain.detect_features(sharp_angle);
  using namespace CGAL::parameters;
  using Size = ScaledSize<Domain>;
  const Criteria criteria(edge_size = Size{&size, 1}, facet_angle = 25,
                          facet_size = Size{&size, facet_radius},
                          facet_distance = Size{&size, surface_distance}, cell_radius_edge_ratio = 2,
                          cell_size = Size{&size, cell_radius});
  const auto complex = refined_complex<Complex>(domain, criteria, most_points, file.string());
  auto mesh = refined_cells(complex);
  if (mesh.cells.empty())
    throw NumericsError("a surface has not been filled by cells", file.string(), "a size below its extent");
  peel_flat_cells(mesh);
  mesh.boundary_names = {surface_name};
  for (const auto& facet : build_facet_table(mesh).facets)
    if (facet.cells[1] < 0) mesh.boundary.push_back({facet.points, 0});
  return mesh;
}

} // namespace undula::geometry
