#include "fom/scene/statement_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fom/scene/body_size.hpp"
#include "fom/scene/expression.hpp"
#include "fom/scene/fluid_size.hpp"
#include "fom/scene/key_place.hpp"
#include "fom/scene/outlined_problem.hpp"
#include "fom/scene/shape_outline.hpp"
#include "geometry/mesh/outline_faults.hpp"
#include "geometry/mesh/polygons.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr int circle_corners = 720;
constexpr double rounding = 1e-9; ///< of an extent

std::string mm(double length) { return plain_number(units::length_to_mm(length)); }

std::string mm(const Point<2>& x) { return "(" + mm(x.x()) + ", " + mm(x.y()) + ") mm"; }

std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

class GeometryChecker {
public:
  GeometryChecker(const Scene& scene, const std::string& scene_name)
      : scene_(scene),
        problem_(scene.problem),
        name_(scene_name),
        axisymmetric_(scene.space == Space::axisymmetric) {}

  StatedWork run() {
    if (has_fluid()) {
      check_shape(problem_.domain.shape, "domain", false);
      check_axis();
    }
    for (const auto& [name, hole] : problem_.holes) check_shape(hole.shape, "hole." + name, false);
    for (const auto& [name, body] : problem_.bodies) check_shape(body.shape, "body." + name, true);
    check_circles();
    check_holes();
    for (const auto& [name, body] : problem_.bodies) check_line(name, body);
    const OutlinedProblem outlined = outlines();
    check_boundary_expressions();
    const PlaneOverlay overlay =
        check_outlines(outlined, [this](const std::vector<int>& segments) { return net_inflow(segments); });
    check_points();
    check_expressions(overlay);
    return check_work(overlay);
  }

private:
  bool has_fluid() const { return fom::has_fluid(problem_.domain); }
  std::string at(const std::string& path) const { return place_of_key(scene_, path, name_); }

  std::vector<Point<2>> coarse(const ShapeStatement& shape, double size, bool body) const {
    return corners_of(shape, size, body && axisymmetric_, circle_corners);
  }

  void check_shape(const ShapeStatement& shape, const std::string& entry, bool body) const {
    if (shape.radius > 0) {
      const double centre = shape.centre[0];
      if (axisymmetric_ && centre < shape.radius && !(body && centre == 0))
        throw InputError("a circle reaches over the axis to negative radii",
                         "r from " + mm(centre - shape.radius) + " mm",
                         body ? "a centre at r >= radius_mm, or at r = 0 for a sphere"
                              : "a centre at r >= radius_mm; \"outline_mm\" for a shape at the axis",
                         at(entry + ".centre_mm"));
      return;
    }
    const auto corners = corners_of(shape, 1);
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (axisymmetric_ && corners[i].x() < 0)
        throw InputError("an outline has a negative radius",
                         "corner " + std::to_string(i + 1) + ", " + mm(corners[i]),
                         "r >= 0 in axisymmetric space", at(entry + ".outline_mm"));
    const auto fault = outline_fault(corners, narrowest_part * largest_extent(corners));
    if (!fault) return;
    const auto edge = [&](std::size_t i) {
      return "edge " + std::to_string(i + 1) + " from " + mm(corners[i]) + " to " +
             mm(corners[(i + 1) % corners.size()]);
    };
    const std::string where = at(entry + ".outline_mm");
    switch (fault->kind) {
      case OutlineFault::Kind::repeated_corner:
        throw InputError("an outline repeats a corner",
                         "corners " + std::to_string(fault->first + 1) + " and " +
                             std::to_string(fault->second + 1) + " are both " + mm(corners[fault->first]),
                         fault->first == 0 && fault->second + 1 == corners.size()
                             ? "an outline that ends at its last corner: it is closed without the first one"
                             : "every corner once",
                         where);
      case OutlineFault::Kind::crossing_edges:
        throw InputError("an outline crosses or touches itself",
                         edge(fault->first) + " and " + edge(fault->second),
                         "corners in order around the shape", where);
      case OutlineFault::Kind::narrow_place:
        throw InputError("an outline is too narrow somewhere to be meshed",
                         mm(fault->distance) + " mm, " + edge(fault->first) +
                             (fault->first == fault->second ? "" : " and " + edge(fault->second)),
                         "at least 1e-6 of its extent", where);
    }
  }

  /// Circles are polygons whose corners are as near to each other as the size asks for.
  void check_circles() const {
    const auto check = [&](const ShapeStatement& shape, double size, const std::string& key) {
      const double corners = 2 * std::numbers::pi * shape.radius / size;
      if (shape.radius > 0 && corners > 0.25 * most_cells)
        refuse_work(corners, "edges around a circle of " + mm(shape.radius) + " mm alone", key);
    };
    const auto boundary_size = [&](const std::string& name) {
      const auto found = problem_.boundaries.find(name);
      const bool own = found != problem_.boundaries.end() && found->second.size > 0;
      return std::pair(own ? found->second.size : problem_.domain.size,
                       own ? "boundary." + name + ".size_mm" : std::string("domain.size_mm"));
    };
    if (has_fluid()) {
      const auto [size, key] = boundary_size(problem_.domain.sides.front());
      check(problem_.domain.shape, size, key);
      for (const auto& [name, hole] : problem_.holes) {
        const auto [hole_size, hole_key] = boundary_size(name);
        check(hole.shape, hole_size, hole_key);
      }
    }
    for (const auto& [name, body] : problem_.bodies) {
      check(body.shape, body.size, "body." + name + ".size_mm");
      if (body.fluid_size > 0 && has_fluid())
        check(body.shape, body.fluid_size, "body." + name + ".fluid_size_mm");
    }
  }

  void check_axis() const {
    if (!axisymmetric_ || problem_.domain.shape.radius > 0) return;
    const auto& outline = problem_.domain.shape.outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
      const std::string& side = problem_.domain.sides[i];
      if (a[0] != 0 || b[0] != 0) continue;
      const auto found = problem_.boundaries.find(side);
      if (found != problem_.boundaries.end() && found->second.kind == BoundaryStatement::Kind::symmetry)
        continue;
      throw InputError(
          "a side on the axis of symmetry would hold the flow",
          "side " + in_quotes(side) + " at r = 0 " +
              (found == problem_.boundaries.end() ? "without a condition: a wall" : "with another condition"),
          "[boundary." + side + "] with kind = \"symmetry\"; sides off the axis by another name",
          at("boundary." + side + ".kind"));
    }
  }

  void check_holes() const {
    if (!has_fluid()) return;
    struct Loop {
      std::string key;
      std::vector<Point<2>> corners;
    };
    const auto key_of = [](const ShapeStatement& shape, const std::string& entry) {
      return entry + (shape.radius > 0 ? ".radius_mm" : ".outline_mm");
    };
    std::vector<Loop> loops = {{"domain", coarse(problem_.domain.shape, problem_.domain.size, false)}};
    for (const auto& [name, hole] : problem_.holes) {
      const Loop loop = {key_of(hole.shape, "hole." + name), coarse(hole.shape, problem_.domain.size, false)};
      for (const auto& other : loops) {
        const bool outer = &other == &loops.front();
        const bool outside = outer && !surrounds(other.corners, loop.corners.front());
        const bool nested = !outer && (surrounds(other.corners, loop.corners.front()) ||
                                       surrounds(loop.corners, other.corners.front()));
        if (outside || nested || meet(other.corners, loop.corners))
          throw InputError(
              outer ? "a hole is not inside of the domain" : "two holes overlap or touch",
              outer ? "[hole." + name + "] " + (outside ? "lies outside" : "reaches the outline") +
                          ", for instance at " + mm(loop.corners.front())
                    : "[hole." + name + "] and [" + other.key.substr(0, other.key.rfind('.')) + "]",
              outer ? "holes strictly inside; a notch belongs to \"domain.outline_mm\""
                    : "holes apart from each other; one outline for both",
              at(loop.key));
      }
      loops.push_back(loop);
    }
  }

  static bool meet(const std::vector<Point<2>>& a, const std::vector<Point<2>>& b) {
    auto edges = polygon_sides(a);
    const std::size_t own = edges.size();
    const auto others = polygon_sides(b);
    edges.insert(edges.end(), others.begin(), others.end());
    bool found = false;
    visit_near_pairs(edges, 0, [&](std::size_t i, std::size_t j) {
      found = i < own && j >= own && segments_meet(edges[i], edges[j]);
      return !found;
    });
    return found;
  }

  void check_line(const std::string& name, const BodyStatement& body) const {
    if (body.line.empty()) return;
    const std::string where = at("body." + name + ".line_mm");
    if (body.line.size() == 1)
      throw InputError("a line has one corner", mm(point_of(body.line.front())), "two or more", where);
    const auto outline = body_corners(body, axisymmetric_);
    const double extent = largest_extent(outline);
    for (std::size_t i = 0; i < body.line.size(); ++i) {
      const Point<2> x = point_of(body.line[i]);
      const double off = distance_to_outline(outline, x);
      const bool on = off <= rounding * extent;
      const bool in_bore =
          body.shape.inner_radius > 0 && (x - point_of(body.shape.centre)).norm() < body.shape.inner_radius;
      if (!on && (in_bore || !surrounds(outline, x)))
        throw InputError("a line leaves its body", "corner " + std::to_string(i + 1) + ", " + mm(x),
                         "corners inside of the body or on its outline", where);
      if (!on && off < narrowest_part * extent)
        throw InputError("a line ends so near to the outline of its body that a flat cell would be left",
                         "corner " + std::to_string(i + 1) + ", " + mm(x) + ", " + mm(off) + " mm from it",
                         "corners on the outline, or at least 1e-6 of the body's extent inside", where);
      if (i == 0) continue;
      const Point<2> before = point_of(body.line[i - 1]);
      if (x == before) throw InputError("a line repeats a corner", mm(x), "every corner once", where);
      constexpr int samples = 32; // of each piece, for outlines that bend in
      for (int k = 1; k < samples; ++k) {
        const Point<2> between = before + (x - before) * k / samples;
        if (!surrounds(outline, between) && distance_to_outline(outline, between) > rounding * extent)
          throw InputError("a line leaves its body", "between " + mm(before) + " and " + mm(x),
                           "pieces inside of the body", where);
      }
    }
    for (std::size_t i = 0; i + 1 < body.line.size(); ++i)
      for (std::size_t j = i + 2; j + 1 < body.line.size(); ++j)
        if (segments_meet({point_of(body.line[i]), point_of(body.line[i + 1])},
                          {point_of(body.line[j]), point_of(body.line[j + 1])}))
          throw InputError("a line crosses itself",
                           "pieces " + std::to_string(i + 1) + " and " + std::to_string(j + 1),
                           "a line without crossings", where);
  }

  OutlinedProblem outlines() {
    OutlinedProblem outlined;
    outlined.where =
        at("domain." + std::string(problem_.domain.shape.radius > 0 ? "radius_mm" : "outline_mm"));
    if (has_fluid()) add_fluid(outlined);
    for (const auto& [name, body] : problem_.bodies) {
      OutlinedBody one;
      one.name = name;
      one.outline = polygon_sides(coarse(body.shape, body.size, true));
      if (body.shape.inner_radius > 0)
        for (const auto& edge :
             polygon_sides(circle(body.shape.centre, body.shape.inner_radius, body.size, circle_corners)))
          one.outline.push_back(edge);
      one.still = held_as_a_whole(name, body, one.outline) && body.displacement[0].empty();
      one.may_be_dry = acts_dry(name);
      one.where = at("body." + name + (body.shape.radius > 0 ? ".radius_mm" : ".outline_mm"));
      outlined.bodies.push_back(std::move(one));
    }
    return outlined;
  }

  bool acts_dry(const std::string& body) const {
    const auto has = [&](const auto& pair) {
      return std::count(pair.second.between.begin(), pair.second.between.end(), body) > 0;
    };
    return std::any_of(problem_.pairs.begin(), problem_.pairs.end(), has) ||
           std::any_of(problem_.loads.begin(), problem_.loads.end(),
                       [&](const auto& load) { return load.second.on == body; });
  }

  /// Domain counter-clockwise, holes clockwise: the fluid to the left.
  void add_fluid(OutlinedProblem& outlined) {
    const auto add = [&](std::vector<Point<2>> corners, bool counter_clockwise, const auto& name_of_edge) {
      const std::size_t n = corners.size();
      const bool reverse = (polygon_area(corners) > 0) != counter_clockwise;
      for (std::size_t i = 0; i < n; ++i) {
        const auto &a = corners[i], &b = corners[(i + 1) % n];
        outlined.fluid.push_back(reverse ? Segment<2>{b, a} : Segment<2>{a, b});
        outlined.side.push_back(side_of(outlined, name_of_edge(i)));
      }
    };
    const auto& domain = problem_.domain;
    add(coarse(domain.shape, domain.size, false), true,
        [&](std::size_t i) { return domain.sides[domain.shape.radius > 0 ? 0 : i]; });
    for (const auto& [name, hole] : problem_.holes)
      add(coarse(hole.shape, domain.size, false), false, [&name = name](std::size_t) { return name; });
    fluid_ = outlined.fluid;
    for (const int side : outlined.side) side_names_.push_back(outlined.sides[side].name);
  }

  int side_of(OutlinedProblem& outlined, const std::string& name) const {
    for (std::size_t s = 0; s < outlined.sides.size(); ++s)
      if (outlined.sides[s].name == name) return static_cast<int>(s);
    OutlinedSide side = {name, OutlinedSide::Kind::closed, at("boundary." + name + ".kind")};
    const auto found = problem_.boundaries.find(name);
    if (found != problem_.boundaries.end()) {
      if (found->second.kind == BoundaryStatement::Kind::velocity) side.kind = OutlinedSide::Kind::velocity;
      if (found->second.kind == BoundaryStatement::Kind::opening) side.kind = OutlinedSide::Kind::opening;
    }
    outlined.sides.push_back(side);
    return static_cast<int>(outlined.sides.size()) - 1;
  }

  Expression expression(const std::string& text) const {
    return {text, scene_.space, problem_.constants, name_};
  }

  static double finite(const Expression& value, const std::string& text, const Point<2>& x, double t,
                       const std::string& where) {
    const auto found = value.finite_value(units::length_to_mm(x[0]), units::length_to_mm(x[1]), t);
    if (!found)
      throw InputError("an expression has no finite value",
                       in_quotes(text) + " at " + mm(x) + ", t = " + plain_number(t) + " s",
                       "an expression that is finite wherever and whenever it counts", where);
    return *found;
  }

  /// The first step and eight times to the end.
  std::vector<double> times() const {
    constexpr int count = 8;
    std::vector<double> all = {scene_.time.step};
    for (int k = 1; k <= count; ++k) all.push_back(scene_.time.end * k / count);
    return all;
  }

  void check_pair(const std::array<std::string, 2>& texts, const std::vector<Point<2>>& points,
                  const std::vector<double>& at_times, const std::string& path) const {
    for (const auto& text : texts) {
      if (text.empty()) continue;
      const Expression value = expression(text);
      for (const double t : at_times)
        for (const auto& x : points) finite(value, text, x, t, at(path));
    }
  }

  void check_boundary_expressions() const {
    for (const auto& [name, boundary] : problem_.boundaries) {
      std::vector<Point<2>> points;
      for (std::size_t i = 0; i < fluid_.size(); ++i)
        if (side_names_[i] == name) {
          points.push_back(fluid_[i].a);
          points.push_back(0.5 * (fluid_[i].a + fluid_[i].b));
          points.push_back(fluid_[i].b);
        }
      check_pair(boundary.velocity, points, times(), "boundary." + name + ".velocity_cm_per_s");
      check_pair({boundary.pressure, ""}, {Point<2>::Zero()}, times(), "boundary." + name + ".pressure_mmHg");
    }
  }

  void check_expressions(const PlaneOverlay& overlay) const {
    const auto points_in = [&](std::size_t region) {
      std::vector<Point<2>> points;
      for (const auto& piece : overlay.pieces) {
        if (overlay.parts[piece.part].inside[region] == 0) continue;
        const auto& x = piece.corners;
        points.insert(points.end(), x.begin(), x.end());
        points.push_back(0.25 * (x[0] + x[1] + x[2] + x[3]));
      }
      return points;
    };
    check_pair(problem_.body_force, points_in(0), times(), "domain.body_force_dyn_per_cm3");
    std::size_t region = 0;
    for (const auto& [name, body] : problem_.bodies) {
      const auto points = points_in(++region);
      const std::string path = "body." + name;
      std::vector<Point<2>> held;
      if (!body.held.empty()) {
        const Expression is_held = expression(body.held);
        for (const auto& x : points)
          if (finite(is_held, body.held, x, 0, at(path + ".held")) != 0) held.push_back(x);
      }
      check_pair(body.displacement, held, times(), path + ".displacement_mm");
      check_pair(body.body_force, points, times(), path + ".body_force_dyn_per_cm3");
      check_pair(body.velocity, points, {0.0}, path + ".velocity_cm_per_s");
    }
  }

  bool held_as_a_whole(const std::string& name, const BodyStatement& body,
                       const std::vector<Segment<2>>& outline) const {
    if (body.held.empty()) return false;
    const Expression held = expression(body.held);
    const auto at_point = [&](const Point<2>& x) {
      return finite(held, body.held, x, 0, at("body." + name + ".held")) != 0;
    };
    Point<2> centre = Point<2>::Zero();
    for (const auto& [a, b] : outline) centre += a / static_cast<double>(outline.size());
    return std::all_of(outline.begin(), outline.end(), [&](const auto& edge) {
      return at_point(edge.a) && at_point(0.5 * (edge.a + edge.b)) && at_point(0.5 * (edge.a + centre));
    });
  }

  /// The largest net flux at a few times, as a part of the flow in and out.
  double net_inflow(const std::vector<int>& segments) const {
    constexpr int pieces = 64;
    double worst = 0;
    for (const double t : times()) {
      double net = 0, gross = 0;
      for (const int segment : segments) {
        const auto found = problem_.boundaries.find(side_names_[segment]);
        if (found == problem_.boundaries.end() || found->second.kind != BoundaryStatement::Kind::velocity)
          continue;
        const auto& velocity = found->second.velocity;
        const Expression u = expression(velocity[0]), v = expression(velocity[1]);
        const std::string where = at("boundary." + side_names_[segment] + ".velocity_cm_per_s");
        const auto& [a, b] = fluid_[segment];
        for (int i = 0; i < pieces; ++i)
          for (const double s : {(i + 0.21132486540518708) / pieces, (i + 0.78867513459481287) / pieces}) {
            const Point<2> x = a + s * (b - a);
            const double weight = axisymmetric_ ? x[0] : 1.0;
            const double out = weight * (finite(u, velocity[0], x, t, where) * (b - a)[1] -
                                         finite(v, velocity[1], x, t, where) * (b - a)[0]);
            net += out;
            gross += std::abs(out);
          }
      }
      if (gross > 0) worst = std::max(worst, std::abs(net) / gross);
    }
    return worst;
  }

  /// Within a shape, or no further outside than `slack` (cm).
  bool within(const ShapeStatement& shape, const Point<2>& x, double slack) const {
    if (shape.radius > 0) {
      const double from_centre = (x - point_of(shape.centre)).norm();
      return from_centre <= shape.radius + slack && from_centre >= shape.inner_radius - slack;
    }
    const auto corners = corners_of(shape, 1);
    const bool inside = surrounds(corners, x);
    const double off = distance_to_outline(corners, x);
    return slack >= 0 ? inside || off <= slack : inside && off > -slack;
  }

  void check_points() const {
    for (const auto& [name, point] : problem_.points) {
      const Point<2> x = point_of(point.at);
      const std::string where = at("point." + name + ".at_mm");
      if (!point.body.empty()) {
        const auto& body = problem_.bodies.at(point.body);
        if (!within(body.shape, x, 0.05 * body.size))
          throw InputError("a point is outside of its body", mm(x),
                           "a point of [body." + point.body + "] at rest", where);
        continue;
      }
      const double slack = rounding * std::max(largest_extent(domain_corners()), 1e-3);
      if (!within(problem_.domain.shape, x, slack))
        throw InputError("a point to follow is not in the fluid", mm(x),
                         "a point of the domain outside of all bodies at rest, or \"body\"", where);
      for (const auto& [hole_name, hole] : problem_.holes)
        if (within(hole.shape, x, -slack) && !near_circle(hole.shape, x))
          throw InputError("a point to follow is not in the fluid", mm(x) + ", in [hole." + hole_name + "]",
                           "a point outside of holes", where);
      for (const auto& [body_name, body] : problem_.bodies)
        if (within(body.shape, x, -slack) && !near_circle(body.shape, x))
          throw InputError("a point to follow is not in the fluid", mm(x) + ", in [body." + body_name + "]",
                           "a point outside of all bodies at rest, or body = \"" + body_name + "\"", where);
    }
  }

  std::vector<Point<2>> domain_corners() const {
    return coarse(problem_.domain.shape, problem_.domain.size, false);
  }

  /// A circle is meshed as a polygon with corners on it: points beside it are left to the mesh.
  static bool near_circle(const ShapeStatement& shape, const Point<2>& x) {
    const double r = (x - point_of(shape.centre)).norm();
    return shape.radius > 0 && (std::abs(r - shape.radius) < 0.05 * shape.radius ||
                                (shape.inner_radius > 0 && std::abs(r - shape.inner_radius) < 0.05 * r));
  }

  [[noreturn]] void refuse_work(double cells, const std::string& of_what, const std::string& key) const {
    throw InputError("the meshes would have too many cells", "about " + plain_number(cells) + " " + of_what,
                     "at most " + std::to_string(most_cells) + " in all; a larger size", at(key));
  }

  StatedWork check_work(const PlaneOverlay& overlay) const {
    StatedWork work;
    double most = 0;
    std::string key;
    const auto offer = [&](double cells, const std::string& its_key) {
      if (cells > most) {
        most = cells;
        key = its_key;
      }
    };
    std::size_t region = 0;
    for (const auto& [name, body] : problem_.bodies) {
      ++region;
      double cells = 0;
      const BodySize size(problem_, name);
      if (size.keys().size() == 1) { // one size: no field to look at
        for (const auto& part : overlay.parts)
          if (part.inside[region] != 0) cells += part.area / (mean_cell_area * body.size * body.size);
        offer(cells, "body." + name + ".size_mm");
      } else {
        std::vector<OverlayPiece> pieces;
        for (const auto& piece : overlay.pieces)
          if (overlay.parts[piece.part].inside[region] != 0) pieces.push_back(piece);
        const auto estimate = estimate_cells(
            pieces, [&](const Point<2>& x) { return size.at(x); }, size.growth(),
            static_cast<int>(size.keys().size()), 100.0 * most_cells);
        cells = estimate.cells;
        for (std::size_t i = 0; i < size.keys().size(); ++i) offer(estimate.by_source[i], size.keys()[i]);
      }
      work.solid_cells += cells;
    }
    if (has_fluid()) {
      const FluidSize size(problem_, domain_polygon(problem_), axisymmetric_);
      std::vector<OverlayPiece> pieces;
      for (const auto& piece : overlay.pieces)
        if (overlay.parts[piece.part].inside[0] != 0) pieces.push_back(piece);
      const auto estimate = estimate_cells(
          pieces, [&](const Point<2>& x) { return size.at(x); }, problem_.domain.growth,
          static_cast<int>(size.keys().size()), 100.0 * most_cells);
      work.fluid_cells = estimate.cells;
      for (std::size_t i = 0; i < size.keys().size(); ++i) offer(estimate.by_source[i], size.keys()[i]);
    }
    const double cells = work.fluid_cells + work.solid_cells;
    if (!(cells <= most_cells)) refuse_work(cells, "cells, most of them by \"" + key + "\"", key);
    return work;
  }

  const Scene& scene_;
  const ProblemStatement& problem_;
  const std::string& name_;
  bool axisymmetric_;
  std::vector<Segment<2>> fluid_; ///< as in the outlined problem
  std::vector<std::string> side_names_;
};

} // namespace

StatedWork check_statement_geometry(const Scene& scene, const std::string& scene_name) {
  return GeometryChecker(scene, scene_name).run();
}

} // namespace undula::fom
