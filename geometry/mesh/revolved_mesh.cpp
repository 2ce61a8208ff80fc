#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "geometry/mesh/outline_faults.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/refined_cells.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Polyline = std::vector<Kernel::Point_3>;

/// Least number of edges of a circle.
constexpr double least_edges = 12;

/// A surface of the body: side of the profile, or plane of a sector.
struct Surface {
  int side = -1;  ///< index into the profile's sides
  int plane = -1; ///< 0 at angle 0, 1 at the end of the sector
  auto operator<=>(const Surface&) const = default;
};

/// The body and its surfaces.
class Revolved {
public:
  Revolved(const TaggedPolygon& profile, double sector_degrees)
      : sides_(polygon_sides(profile.points)),
        tags_(profile.tags),
        whole_(sector_degrees == 360),
        sector_(sector_degrees * std::numbers::pi / 180) {
    for (const auto& hole : profile.holes)
      for (const auto& side : polygon_sides(hole.points)) {
        sides_.push_back(side);
        tags_.push_back(hole.tag);
      }
    for (const auto& side : sides_) {
      extent_ = std::max({extent_, std::abs(side.a.y()), side.a.x()});
      low_ = std::min(low_, side.a.y());
      high_ = std::max(high_, side.a.y());
      widest_ = std::max(widest_, side.a.x());
    }
  }

  bool whole() const { return whole_; }
  const std::vector<Segment<2>>& sides() const { return sides_; }
  int tag(int side) const { return tags_[side]; }
  bool on_axis(int side) const { return sides_[side].a.x() == 0 && sides_[side].b.x() == 0; }

  CGAL::Bbox_3 box() const {
    const double margin = 0.1 * (widest_ + high_ - low_);
    return {-widest_ - margin, -widest_ - margin, low_ - margin,
            widest_ + margin,  widest_ + margin,  high_ + margin};
  }

  static Point<2> meridian(const Point<3>& x) { return {std::hypot(x.x(), x.y()), x.z()}; }

  /// In [0, 2 pi).
  static double angle(const Point<3>& x) {
    const double phi = std::atan2(x.y(), x.x());
    return phi < 0 ? phi + 2 * std::numbers::pi : phi;
  }

  Point<3> place(const Point<2>& meridian, double phi) const {
    return {meridian.x() * std::cos(phi), meridian.x() * std::sin(phi), meridian.y()};
  }
  Point<3> place(const Point<2>& meridian, int plane) const {
    return plane == 0 ? Point<3>(meridian.x(), 0, meridian.y()) : place(meridian, sector_);
  }

  bool contains(const Point<3>& x) const {
    return (whole_ || angle(x) <= sector_) && inside_outline(sides_, meridian(x));
  }

  /// Distance of x to a surface, cm.
  double distance_to(const Surface& surface, const Point<3>& x) const {
    if (surface.side >= 0) return distance(sides_[surface.side], meridian(x));
    if (surface.plane == 0) return std::abs(x.y());
    return std::abs(std::cos(sector_) * x.y() - std::sin(sector_) * x.x());
  }

  std::vector<Surface> surfaces() const {
    std::vector<Surface> all;
    for (int s = 0; s < static_cast<int>(sides_.size()); ++s)
      if (!on_axis(s)) all.push_back({s, -1});
    if (!whole_)
      for (int plane : {0, 1}) all.push_back({-1, plane});
    return all;
  }

  /// The point of the surfaces' intersection next to x.
  Point<3> onto(const std::set<Surface>& surfaces, const Point<3>& x) const {
    std::vector<int> on_sides;
    int planes = 0, plane = -1;
    for (const auto& surface : surfaces) {
      if (surface.side >= 0) on_sides.push_back(surface.side);
      if (surface.plane >= 0) {
        ++planes;
        plane = surface.plane;
      }
    }
    Point<2> at = meridian(x);
    if (planes == 2) at.x() = 0; // on the axis
    if (on_sides.size() == 1 && planes < 2) at = nearest_point(sides_[on_sides[0]], at);
    if (on_sides.size() == 1 && planes == 2) {
      const auto& side = sides_[on_sides[0]];
      at = side.a.x() < side.b.x() ? side.a : side.b;
    }
    if (on_sides.size() >= 2) { // the corner that they share
      const auto &p = sides_[on_sides[0]], &q = sides_[on_sides[1]];
      at = p.a == q.a || p.a == q.b ? p.a : p.b;
    }
    return planes > 0 ? place(at, plane) : place(at, angle(x));
  }

  /// The lines that the mesh keeps. Circles are fine polygons, whose points `onto` puts right.
  std::vector<Polyline> lines(const SpaceSizeField& size) const {
    std::vector<Polyline> all;
    const auto point = [](const Point<3>& x) { return Kernel::Point_3(x.x(), x.y(), x.z()); };
    std::vector<Point<2>> corners;
    for (const auto& side : sides_) corners.push_back(side.a);
    const double turn = whole_ ? 2 * std::numbers::pi : sector_;
    for (const auto& corner : corners) {
      if (corner.x() == 0) continue;
      const double edge = size(place(corner, 0.5 * turn));
      const int n = std::max(64, static_cast<int>(4 * corner.x() * turn / edge));
      Polyline arc;
      for (int i = 0; i < n; ++i) arc.push_back(point(place(corner, turn * i / n)));
      arc.push_back(whole_ ? arc.front() : point(place(corner, 1)));
      if (!whole_) arc.front() = point(place(corner, 0));
      all.push_back(std::move(arc));
    }
    if (whole_) return all;
    for (int s = 0; s < static_cast<int>(sides_.size()); ++s)
      for (int plane : {0, 1}) {
        if (on_axis(s) && plane == 1) continue;
        all.push_back({point(place(sides_[s].a, plane)), point(place(sides_[s].b, plane))});
      }
    return all;
  }

private:
  std::vector<Segment<2>> sides_;
  std::vector<int> tags_;
  bool whole_;
  double sector_; // radians
  double extent_ = 0, widest_ = 0;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

void check(const TaggedPolygon& profile, double sector_degrees) {
  const std::string where = profile.names.empty() ? "profile of a body of revolution"
                                                  : "profile with boundary '" + profile.names.front() + "'";
  const auto refuse = [&](const std::string& seen, const std::string& allowed) {
    throw InputError("a body of revolution cannot be meshed", seen, allowed, where);
  };
  if (profile.points.size() < 3 || profile.tags.size() != profile.points.size() ||
      !(polygon_area(profile.points) > 0) ||
      outline_fault(profile.points, narrowest_part * largest_extent(profile.points)))
    refuse(
        std::to_string(profile.points.size()) + " points",
        "a simple counter-clockwise polygon with one tag per side, nowhere narrower than 1e-6 of its extent");
  for (const auto& x : profile.points)
    if (!(x.x() >= 0)) refuse("a corner at r = " + std::to_string(x.x()) + " cm", "r of 0 or more");
  for (const auto& hole : profile.holes)
    for (const auto& x : hole.points)
      if (!surrounds(profile.points, x) || !(x.x() > 0))
        refuse(
            "a corner of a hole at r = " + std::to_string(x.x()) + ", z = " + std::to_string(x.y()) + " cm",
            "holes inside of the profile, off the axis");
  if (!(sector_degrees > 0 && sector_degrees <= 360))
    refuse(std::to_string(sector_degrees) + " degrees", "an angle above 0 and up to 360 degrees");
}

/// No longer than a part of the circle through the point.
struct EdgeSize : ScaledSize<Domain> {
  double operator()(const Point_3& x, const int dimension, const Index& index) const {
    const double wanted = ScaledSize<Domain>::operator()(x, dimension, index);
    const double around = 2 * std::numbers::pi * std::hypot(x.x(), x.y()) / least_edges;
    return around > 0 ? std::min(wanted, std::max(around, 0.2 * wanted)) : wanted;
  }
};

/// The surface that a facet of the boundary lies on.
const Surface& surface_of(const std::vector<Surface>& surfaces, const Revolved& body,
                          const SimplexMesh<3>& mesh, const Facet<3>& facet) {
  const Surface* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& surface : surfaces) {
    double farthest = 0;
    for (const int p : facet.points) farthest = std::max(farthest, body.distance_to(surface, mesh.points[p]));
    if (farthest >= least) continue;
    least = farthest;
    nearest = &surface;
  }
  const double size = (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).norm();
  if (!nearest || least > 0.01 * size) {
    std::ostringstream where;
    where << "facet at (" << mesh.points[facet.points[0]].transpose() << ") cm, " << least
          << " cm off the surface";
    throw NumericsError("the mesh lost the boundary of a body of revolution", where.str(),
                        "a size below the thickness of the body");
  }
  return *nearest;
}

/// Finds on which surface each facet of the boundary lies, and moves its points onto their surfaces.
void add_boundary(const Revolved& body, const std::vector<std::string>& names, SimplexMesh<3>& mesh) {
  mesh.boundary_names = names;
  if (!body.whole()) mesh.boundary_names.emplace_back(symmetry_name);
  const auto surfaces = body.surfaces();
  std::vector<std::set<Surface>> of_points(mesh.points.size());
  for (const auto& facet : build_facet_table(mesh).facets) {
    if (facet.cells[1] >= 0) continue;
    const auto& surface = surface_of(surfaces, body, mesh, facet);
    for (const int p : facet.points) of_points[p].insert(surface);
    const int tag =
        surface.plane >= 0 ? static_cast<int>(mesh.boundary_names.size()) - 1 : body.tag(surface.side);
    mesh.boundary.push_back({facet.points, tag});
  }
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    if (!of_points[p].empty()) mesh.points[p] = body.onto(of_points[p], mesh.points[p]);
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c)
    if (!(cell_measure(mesh, c) > 0)) {
      std::ostringstream where;
      where << "cell at (" << mesh.points[mesh.cells[c][0]].transpose() << ") cm";
      throw NumericsError("a cell of a body of revolution is flat or inverted", where.str(), "a finer size");
    }
}

} // namespace

SimplexMesh<3> mesh_revolved(const TaggedPolygon& profile, double sector_degrees, const SpaceSizeField& size,
                             int most_points) {
  check(profile, sector_degrees);
  const Revolved body(profile, sector_degrees);
  CGAL::Random random(0);
  CGAL::get_default_random() = CGAL::Random(0); // the result depends on the input only
  using namespace CGAL::parameters;
  Domain domain(
      function =
          [&body](const Kernel::Point_3& x) {
            return body.contains({x.x(), x.y(), x.z()}) ? 1 : 0;
          },
      bounding_object = body.box(), p_rng = &random, relative_error_bound = 1e-7);
  const auto lines = body.lines(size);
  domain.add_features(lines.begin(), lines.end());
  using Size = ScaledSize<Domain>;
  const Criteria criteria(edge_size = EdgeSize{{&size, 1}}, facet_angle = 25,
                          facet_size = Size{&size, facet_radius},
                          facet_distance = Size{&size, surface_distance}, cell_radius_edge_ratio = 2,
                          cell_size = Size{&size, cell_radius});
  const auto complex =
      refined_complex<Complex>(domain, criteria, most_points, "the mesh of a body of revolution");
  auto mesh = refined_cells(complex);
  peel_flat_cells(mesh);
  add_boundary(body, profile.names, mesh);
  return mesh;
}

} // namespace undula::geometry
