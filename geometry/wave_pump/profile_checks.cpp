// Checks of a pump profile by exact predicates.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <sstream>
#include <tuple>

#include "geometry/mesh/outline_faults.hpp"
#include "geometry/wave_pump/membrane_outline.hpp"
#include "geometry/wave_pump/profile.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 exact(const Point<2>& x) { return {x.x(), x.y()}; }

std::vector<Kernel::Point_2> exact_points(const std::vector<Point<2>>& points) {
  std::vector<Kernel::Point_2> all;
  for (const auto& point : points) all.push_back(exact(point));
  return all;
}

std::string text(const Point<2>& x) {
  std::ostringstream out;
  out.precision(12);
  out << "(" << x.x() << ", " << x.y() << ")";
  return out.str();
}

std::string text(double x) {
  std::ostringstream out;
  out.precision(12);
  out << x;
  return out.str();
}

/// A directed edge of a closed outline and what a message says about it.
struct Edge {
  Point<2> from, to;
  std::string curve;
  int line = 0;

  Kernel::Segment_2 segment() const { return {exact(from), exact(to)}; }
  std::string text() const { return curve + " " + undula::geometry::text(from) + " - " + geometry::text(to); }
};

class Checker {
public:
  explicit Checker(const PumpProfile& profile) : profile_(profile) {}

  void run() const {
    check_points(profile_.housing, 2);
    check_points(profile_.stator, 2);
    check_points(profile_.magnet, 3);
    check_ends();
    check_membrane();

    const auto outline = fluid_outline(profile_);
    const auto fluid = fluid_edges(outline);
    check_simple(fluid, "the walls of the pump cross or touch");
    const auto polygon = exact_points(outline.points);
    if (CGAL::orientation_2(polygon.begin(), polygon.end()) != CGAL::COUNTERCLOCKWISE)
      throw InputError("the walls of the pump enclose no fluid", "the housing lies inside the stator",
                       "housing outside of the stator, both listed from the inlet to the outlet",
                       where(outline.lines.front()));

    const auto membrane =
        solid_edges(membrane_outline(profile_.membrane).points, "membrane", {}, profile_.membrane.line);
    const auto magnet = solid_edges(profile_.magnet.points, "magnet", profile_.magnet.lines, 0);
    check_simple(magnet, "the magnet's polygon crosses or touches itself");
    check_inside(membrane, fluid, outline.points);
    check_inside(magnet, fluid, outline.points);
    check_disjoint(membrane, magnet);
    const double extent = largest_extent(outline.points);
    check_width(fluid, extent);
    check_width(membrane, extent);
    check_width(magnet, extent);
  }

private:
  std::string where(int line) const {
    const auto file = profile_.file.empty() ? std::string("pump profile") : profile_.file.string();
    return line > 0 ? file + ":" + std::to_string(line) : file;
  }

  static int line(const ProfileCurve& curve, std::size_t i) {
    return curve.lines.empty() ? 0 : curve.lines[i];
  }

  void check_points(const ProfileCurve& curve, std::size_t least) const {
    if (curve.points.size() < least)
      throw InputError("'" + curve.key + "' has too few points", std::to_string(curve.points.size()),
                       "at least " + std::to_string(least),
                       where(curve.lines.empty() ? 0 : curve.lines.front()));
    for (std::size_t i = 0; i < curve.points.size(); ++i)
      if (curve.points[i].x() < 0)
        throw InputError("a point of '" + curve.key + "' has a negative radius", text(curve.points[i]),
                         "r >= 0", where(line(curve, i)));
    constexpr double farthest = 1e4; // cm
    for (std::size_t i = 0; i < curve.points.size(); ++i)
      if (!(curve.points[i].cwiseAbs().maxCoeff() <= farthest))
        throw InputError("a point of '" + curve.key + "' is too far away", text(curve.points[i]) + " cm",
                         "coordinates within 1e4 cm", where(line(curve, i)));
    for (std::size_t i = 1; i < curve.points.size(); ++i)
      if (curve.points[i] == curve.points[i - 1])
        throw InputError("'" + curve.key + "' repeats a point", text(curve.points[i]), "distinct points",
                         where(line(curve, i)));
  }

  void check_ends() const {
    const auto& housing = profile_.housing;
    const auto& stator = profile_.stator;
    for (std::size_t i = 0; i < housing.points.size(); ++i)
      if (housing.points[i].x() == 0)
        throw InputError("the housing touches the axis", text(housing.points[i]), "r > 0",
                         where(line(housing, i)));
    for (const std::size_t end : {std::size_t{0}, stator.points.size() - 1})
      if (stator.points[end].x() != 0)
        throw InputError("the stator does not end on the axis", text(stator.points[end]), "r = 0",
                         where(line(stator, end)));
    const double inlet = housing.points.front().y(), top = stator.points.front().y();
    const double nose = stator.points.back().y(), outlet = housing.points.back().y();
    if (!(inlet > top && top > nose && nose > outlet))
      throw InputError("inlet, stator and outlet are out of order along the axis",
                       "z = " + text(inlet) + ", " + text(top) + ", " + text(nose) + ", " + text(outlet),
                       "z of inlet rim > stator top > stator nose > outlet rim", where(line(stator, 0)));
  }

  void check_membrane() const {
    const auto& membrane = profile_.membrane;
    const auto& table = membrane.thickness;
    check_points(table, 2);
    for (std::size_t i = 0; i < table.points.size(); ++i)
      if (!(table.points[i].y() > 0))
        throw InputError("the membrane has no thickness", text(table.points[i].y()) + " cm", "thickness > 0",
                         where(line(table, i)));
    for (std::size_t i = 1; i < table.points.size(); ++i)
      if (!(table.points[i].x() > table.points[i - 1].x()))
        throw InputError("the radii of 'membrane.thickness' do not ascend", text(table.points[i].x()) + " cm",
                         "r > " + text(table.points[i - 1].x()), where(line(table, i)));
    if (table.points.front().x() != membrane.inner_radius || table.points.back().x() != membrane.outer_radius)
      throw InputError("'membrane.thickness' does not span the membrane",
                       "r from " + text(table.points.front().x()) + " to " + text(table.points.back().x()),
                       "r from inner_radius = " + text(membrane.inner_radius) +
                           " to outer_radius = " + text(membrane.outer_radius),
                       where(line(table, 0)));
    if (!(membrane.clamp_radius > membrane.inner_radius && membrane.clamp_radius < membrane.outer_radius))
      throw InputError(
          "'membrane.clamp_radius' lies outside of the membrane", text(membrane.clamp_radius) + " cm",
          text(membrane.inner_radius) + " < r < " + text(membrane.outer_radius), where(membrane.line));
    for (const auto& [name, radius, largest] :
         {std::tuple{"tip", membrane.tip_radius, largest_tip_radius(membrane)},
          std::tuple{"rim", membrane.rim_radius, largest_rim_radius(membrane)}})
      if (radius != 0 && !corner_fits(radius, largest))
        throw InputError(
            std::string("the corners of the membrane's ") + name + " cannot have this radius",
            text(radius) + " cm",
            "0 (sharp), or " + text(smallest_corner_radius(largest)) + " to " + text(largest) + " cm",
            where(membrane.line));
  }

  static std::vector<Edge> fluid_edges(const FluidOutline& outline) {
    static const char* names[] = {"housing", "stator", "axis", "inlet", "outlet"};
    std::vector<Edge> edges;
    for (std::size_t i = 0, n = outline.points.size(); i < n; ++i)
      edges.push_back(
          {outline.points[i], outline.points[(i + 1) % n], names[outline.curves[i]], outline.lines[i]});
    return edges;
  }

  static std::vector<Edge> solid_edges(const std::vector<Point<2>>& points, const std::string& name,
                                       const std::vector<int>& lines, int otherwise) {
    std::vector<Edge> edges;
    for (std::size_t i = 0, n = points.size(); i < n; ++i)
      edges.push_back({points[i], points[(i + 1) % n], name, lines.empty() ? otherwise : lines[i]});
    return edges;
  }

  /// Edges of a closed polygon may share the point between neighbours and nothing else.
  void check_simple(const std::vector<Edge>& edges, const std::string& what) const {
    const std::size_t n = edges.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const auto a = edges[i].segment(), b = edges[j].segment();
        bool bad = false;
        if (a.is_degenerate() || b.is_degenerate())
          bad = true;
        else if (j == i + 1)
          bad = a.has_on(b.target()) || b.has_on(a.source());
        else if (i == 0 && j == n - 1)
          bad = a.has_on(b.source()) || b.has_on(a.target());
        else
          bad = CGAL::do_intersect(a, b);
        if (bad)
          throw InputError(
              what,
              edges[i].text() + " and " + edges[j].text() + " (line " + std::to_string(edges[j].line) + ")",
              "a profile that neither crosses nor touches itself", where(edges[i].line));
      }
  }

  /// Meshes of narrower places than this have no end in double precision.
  void check_width(const std::vector<Edge>& edges, double extent) const {
    std::vector<Point<2>> corners;
    for (const auto& edge : edges) corners.push_back(edge.from);
    const auto fault = outline_fault(corners, narrowest_part * extent);
    if (!fault) return;
    const auto &a = edges[fault->first], &b = edges[fault->second];
    const bool one = fault->first == fault->second;
    throw InputError(one ? "an edge of the profile is too short to be meshed"
                         : "two edges of the profile are too near to each other to be meshed",
                     text(fault->distance) + " cm, " + a.text() +
                         (one ? "" : " and " + b.text() + " (line " + std::to_string(b.line) + ")"),
                     "at least " + text(narrowest_part * extent) + " cm, 1e-6 of the profile's extent",
                     where(a.line));
  }

  void check_no_contact(const std::vector<Edge>& solid, const std::vector<Edge>& others) const {
    for (const auto& a : solid)
      for (const auto& b : others)
        if (CGAL::do_intersect(a.segment(), b.segment()))
          throw InputError("the " + a.curve + " crosses or touches the " + b.curve,
                           a.text() + " and " + b.text(), "a positive clearance", where(a.line));
  }

  void check_inside(const std::vector<Edge>& solid, const std::vector<Edge>& fluid,
                    const std::vector<Point<2>>& outline) const {
    check_no_contact(solid, fluid);
    if (side(outline, solid.front().from) != CGAL::ON_BOUNDED_SIDE)
      throw InputError("the " + solid.front().curve + " lies outside of the fluid domain",
                       text(solid.front().from), "between housing and stator", where(solid.front().line));
  }

  void check_disjoint(const std::vector<Edge>& a, const std::vector<Edge>& b) const {
    check_no_contact(a, b);
    const auto contains = [](const std::vector<Edge>& outer, const std::vector<Edge>& inner) {
      std::vector<Point<2>> points;
      for (const auto& edge : outer) points.push_back(edge.from);
      return side(points, inner.front().from) != CGAL::ON_UNBOUNDED_SIDE;
    };
    if (contains(a, b) || contains(b, a))
      throw InputError("the " + a.front().curve + " and the " + b.front().curve + " overlap",
                       text(a.front().from) + " and " + text(b.front().from), "solids apart from each other",
                       where(b.front().line));
  }

  static CGAL::Bounded_side side(const std::vector<Point<2>>& outline, const Point<2>& x) {
    const auto points = exact_points(outline);
    return CGAL::bounded_side_2(points.begin(), points.end(), exact(x), Kernel());
  }

  const PumpProfile& profile_;
};

} // namespace

void check_pump_profile(const PumpProfile& profile) { Checker(profile).run(); }

} // namespace undula::geometry
