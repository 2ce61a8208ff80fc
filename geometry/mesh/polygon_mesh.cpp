#include "geometry/mesh/polygon_mesh.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>

#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/outline_faults.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

/// Edges longer than this times the target are split: the edges of the finished mesh then scatter about the
/// target.
constexpr double longest = 4.0 / 3.0;

/// Which cells to refine next: first the largest against the size field, then the sharpest.
class Criteria {
public:
  struct Quality {
    double oversize = 0;     ///< (longest edge / target size)^2
    double squared_sine = 0; ///< of the smallest angle

    bool operator<(const Quality& other) const {
      if (oversize > 1 || other.oversize > 1) return oversize > other.oversize;
      return squared_sine < other.squared_sine;
    }
  };

  class Is_bad {
  public:
    Is_bad(const SizeField& size, double bound, const Triangulation& mesh)
        : size_(&size), bound_(bound), mesh_(&mesh) {}

    CGAL::Mesh_2::Face_badness operator()(const Quality& quality) const {
      if (quality.oversize > 1) return CGAL::Mesh_2::IMPERATIVELY_BAD;
      return quality.squared_sine < bound_ ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }

    CGAL::Mesh_2::Face_badness operator()(const Triangulation::Face_handle& face, Quality& quality) const {
      // Two cells per point. To count the faces, CGAL goes round the hull.
      if (2 * mesh_->number_of_vertices() > most_cells)
        throw InputError("a mesh would have too many cells", "more than " + std::to_string(most_cells),
                         "a coarser size, or a shape without places that are narrow against it",
                         "a polygon to mesh");
      std::array<Point<2>, 3> x;
      for (int i = 0; i < 3; ++i) x[i] = {face->vertex(i)->point().x(), face->vertex(i)->point().y()};
      std::array<double, 3> edge = {(x[1] - x[0]).squaredNorm(), (x[2] - x[1]).squaredNorm(),
                                    (x[0] - x[2]).squaredNorm()};
      std::sort(edge.begin(), edge.end());
      const Point<2> a = x[1] - x[0], b = x[2] - x[0];
      const double twice_area = a.x() * b.y() - a.y() * b.x();
      const double target = (*size_)((x[0] + x[1] + x[2]) / 3.0);
      quality.oversize = edge[2] / (longest * longest * target * target);
      quality.squared_sine = twice_area * twice_area / (edge[1] * edge[2]);
      return (*this)(quality);
    }

  private:
    const SizeField* size_;
    double bound_;
    const Triangulation* mesh_;
  };

  Criteria(const SizeField& size, double min_angle, const Triangulation& mesh) : size_(&size), mesh_(&mesh) {
    const double sine = std::sin(min_angle * std::numbers::pi / 180);
    bound_ = sine * sine;
  }
  Is_bad is_bad_object() const { return {*size_, bound_, *mesh_}; }

private:
  const SizeField* size_;
  double bound_;
  const Triangulation* mesh_;
};

/// Refinement comes to no end, or crashes, where the outline folds within the rounding of its coordinates.
void check_narrow_places(const std::vector<Point<2>>& points, double extent, const std::string& where) {
  const auto fault = outline_fault(points, narrowest_part * extent);
  if (!fault) return;
  std::ostringstream seen;
  seen << fault->distance << " cm at (" << points[fault->first].transpose() << ") cm";
  throw InputError("a polygon is too narrow somewhere to be meshed", seen.str(),
                   "at least " + std::to_string(narrowest_part) + " of its extent", where);
}

void check(const TaggedPolygon& polygon) {
  std::vector<Kernel::Point_2> points;
  for (const auto& x : polygon.points) points.emplace_back(x.x(), x.y());
  const bool closed = points.size() >= 3 && polygon.tags.size() == points.size();
  if (!closed || !CGAL::is_simple_2(points.begin(), points.end(), Kernel()) ||
      CGAL::orientation_2(points.begin(), points.end(), Kernel()) != CGAL::COUNTERCLOCKWISE)
    throw InputError(
        "a polygon cannot be meshed", std::to_string(points.size()) + " points",
        "a simple counter-clockwise polygon with one tag per edge",
        polygon.names.empty() ? "polygon" : "polygon with boundary '" + polygon.names.front() + "'");
  check_narrow_places(
      polygon.points, largest_extent(polygon.points),
      polygon.names.empty() ? "polygon" : "polygon with boundary '" + polygon.names.front() + "'");
}

/// A point inside a simple polygon: half-way between the first two crossings of a level between its corners.
Kernel::Point_2 point_inside(const std::vector<Point<2>>& points) {
  std::vector<double> levels;
  for (const auto& x : points) levels.push_back(x.y());
  std::sort(levels.begin(), levels.end());
  double level = 0, widest = -1;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    if (levels[i + 1] - levels[i] > widest) {
      widest = levels[i + 1] - levels[i];
      level = 0.5 * (levels[i] + levels[i + 1]);
    }
  std::vector<double> crossings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    if ((a.y() > level) != (b.y() > level))
      crossings.push_back(a.x() + (b.x() - a.x()) * (level - a.y()) / (b.y() - a.y()));
  }
  std::sort(crossings.begin(), crossings.end());
  return {0.5 * (crossings[0] + crossings[1]), level};
}

/// The corners of a hole, clockwise: with the meshed side to the left of its edges.
std::vector<Point<2>> clockwise_hole(const TaggedHole& hole, const TaggedPolygon& outside) {
  std::vector<Kernel::Point_2> points, outline;
  for (const auto& x : hole.points) points.emplace_back(x.x(), x.y());
  for (const auto& x : outside.points) outline.emplace_back(x.x(), x.y());
  const std::string where = "hole with boundary '" + outside.names[hole.tag] + "'";
  if (points.size() < 3 || !CGAL::is_simple_2(points.begin(), points.end(), Kernel()))
    throw InputError("a hole cannot be meshed", std::to_string(points.size()) + " points", "a simple polygon",
                     where);
  for (const auto& x : points)
    if (CGAL::bounded_side_2(outline.begin(), outline.end(), x, Kernel()) != CGAL::ON_BOUNDED_SIDE) {
      std::ostringstream seen;
      seen << "corner (" << x.x() << ", " << x.y() << ") cm";
      throw InputError("a hole is not inside of its polygon", seen.str(), "corners strictly inside", where);
    }
  check_narrow_places(hole.points, largest_extent(outside.points), where);
  auto result = hole.points;
  if (CGAL::orientation_2(points.begin(), points.end(), Kernel()) == CGAL::COUNTERCLOCKWISE)
    std::reverse(result.begin(), result.end());
  return result;
}

/// Numbers the vertices along a Hilbert curve and fills points and cells. Returns the new index of the
/// vertices given by handle.
void fill_cells(Triangulation& triangulation, SimplexMesh<2>& mesh) {
  std::vector<Triangulation::Vertex_handle> vertices;
  for (auto v : triangulation.finite_vertex_handles()) v->info() = -1;
  for (auto face : triangulation.finite_face_handles())
    if (face->is_in_domain())
      for (int i = 0; i < 3; ++i)
        if (face->vertex(i)->info() < 0) {
          face->vertex(i)->info() = static_cast<int>(vertices.size());
          vertices.push_back(face->vertex(i));
        }
  std::vector<Kernel::Point_2> points;
  for (const auto& v : vertices) points.push_back(v->point());
  // Sorted by coordinates first: the curve then depends on the set of points only.
  std::sort(points.begin(), points.end());
  CGAL::hilbert_sort(points.begin(), points.end(), Kernel());
  std::map<Kernel::Point_2, int> number;
  for (std::size_t i = 0; i < points.size(); ++i) number.emplace(points[i], static_cast<int>(i));
  for (const auto& v : vertices) v->info() = number.at(v->point());

  for (const auto& x : points) mesh.points.emplace_back(x.x(), x.y());
  for (auto face : triangulation.finite_face_handles())
    if (face->is_in_domain()) {
      std::array<int, 3> cell = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      std::rotate(cell.begin(), std::min_element(cell.begin(), cell.end()), cell.end());
      mesh.cells.push_back(cell);
    }
  std::sort(mesh.cells.begin(), mesh.cells.end());
}

using Corners = std::vector<Triangulation::Vertex_handle>;

/// The boundary edge that starts at each point, by its end; -1 for points inside.
std::vector<int> next_on_boundary(const SimplexMesh<2>& mesh) {
  std::map<std::array<int, 2>, int> edges; // directed edge -> its cells
  for (const auto& cell : mesh.cells)
    for (int i = 0; i < 3; ++i) ++edges[{cell[i], cell[(i + 1) % 3]}];
  std::vector<int> next(mesh.points.size(), -1);
  for (const auto& [edge, count] : edges)
    if (!edges.contains({edge[1], edge[0]})) next[edge[0]] = edge[1];
  return next;
}

/// Walks along the boundary from each corner to the next: exact even where split points are rounded off the
/// straight edge.
template <typename TagOfEdge>
void add_boundary(const Corners& corners, const std::vector<int>& next, const TagOfEdge& tag,
                  SimplexMesh<2>& mesh) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int end = corners[(i + 1) % corners.size()]->info();
    for (int at = corners[i]->info(); at != end; at = next[at]) {
      if (at < 0 || next[at] < 0 || mesh.boundary.size() > mesh.points.size()) {
        std::ostringstream where;
        where << "edge " << i << " of the polygon, from (" << corners[i]->point() << ")";
        throw NumericsError("the mesh lost an edge of its polygon", where.str(),
                            "a coarser size or a smaller angle bound");
      }
      mesh.boundary.push_back({{at, next[at]}, tag(i)});
    }
  }
}

/// Inserts a closed polygon and its edges.
Corners insert_loop(Triangulation& triangulation, const std::vector<Point<2>>& points) {
  Corners corners;
  for (const auto& x : points) corners.push_back(triangulation.insert(Kernel::Point_2(x.x(), x.y())));
  for (std::size_t i = 0; i < corners.size(); ++i)
    triangulation.insert_constraint(corners[i], corners[(i + 1) % corners.size()]);
  return corners;
}

} // namespace

SimplexMesh<2> mesh_polygon(const TaggedPolygon& polygon, const SizeField& size, double min_angle) {
  check(polygon);
  Triangulation triangulation;
  const Corners corners = insert_loop(triangulation, polygon.points);
  for (const auto& line : polygon.inner_lines)
    triangulation.insert_constraint(corners[line[0]], corners[line[1]]);
  std::vector<Corners> holes;
  std::vector<Kernel::Point_2> seeds;
  for (const auto& hole : polygon.holes) {
    holes.push_back(insert_loop(triangulation, clockwise_hole(hole, polygon)));
    seeds.push_back(point_inside(hole.points));
  }
  for (const auto& path : polygon.inner_paths)
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      triangulation.insert_constraint(Kernel::Point_2(path[i].x(), path[i].y()),
                                      Kernel::Point_2(path[i + 1].x(), path[i + 1].y()));

  const Criteria criteria(size, min_angle, triangulation);
  if (seeds.empty())
    CGAL::refine_Delaunay_mesh_2(triangulation, criteria);
  else
    CGAL::refine_Delaunay_mesh_2(triangulation, seeds.begin(), seeds.end(), criteria);

  SimplexMesh<2> mesh;
  fill_cells(triangulation, mesh);
  mesh.boundary_names = polygon.names;
  const auto next = next_on_boundary(mesh);
  add_boundary(
      corners, next, [&](std::size_t edge) { return polygon.tags[edge]; }, mesh);
  for (std::size_t h = 0; h < holes.size(); ++h)
    add_boundary(
        holes[h], next, [&](std::size_t) { return polygon.holes[h].tag; }, mesh);
  return mesh;
}

} // namespace undula::geometry
