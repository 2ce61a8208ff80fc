#include "fom/scene/general_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fom/fom.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/expression.hpp"
#include "fom/scene/scene_time.hpp"
#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/polygons.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double min_angle = 25; ///< degrees, of the meshes

Point<2> point_of(const Position& position) { return {position[0], position[1]}; }

/// Corners of a circle, four of them on the axes through its centre, no further apart than `size`.
std::vector<Point<2>> circle(const Position& centre, double radius, double size) {
  const double quarter = 0.5 * std::numbers::pi * radius / size;
  const int corners = 4 * std::clamp(static_cast<int>(std::ceil(quarter)), 4, 100000);
  std::vector<Point<2>> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.push_back(point_of(centre) + radius * Point<2>(std::cos(angle), std::sin(angle)));
  }
  return points;
}

/// The half of a circle with r >= 0, about a centre on the axis.
std::vector<Point<2>> half_circle(const Position& centre, double radius, double size) {
  auto points = circle(centre, radius, size);
  std::erase_if(points, [&](const Point<2>& x) { return x[0] < 1e-6 * radius; });
  // From the lower pole to the upper one.
  std::sort(points.begin(), points.end(), [](const Point<2>& a, const Point<2>& b) { return a[1] < b[1]; });
  points.insert(points.begin(), Point<2>(0.0, centre[1] - radius));
  points.emplace_back(0.0, centre[1] + radius);
  return points;
}

/// `axisymmetric`: circles about a point of the axis are half discs, the meridian of a sphere.
std::vector<Point<2>> corners_of(const ShapeStatement& shape, double size, bool axisymmetric = false) {
  if (shape.radius > 0 && axisymmetric && shape.centre[0] == 0)
    return half_circle(shape.centre, shape.radius, size);
  if (shape.radius > 0) return circle(shape.centre, shape.radius, size);
  std::vector<Point<2>> points;
  for (const auto& corner : shape.outline) points.push_back(point_of(corner));
  return points;
}

/// Counter-clockwise, with the tags of its edges.
void orient(TaggedPolygon& polygon) {
  if (polygon_area(polygon.points) > 0) return;
  std::reverse(polygon.points.begin(), polygon.points.end());
  // Edge j now runs from the old corner n-1-j to n-2-j.
  std::reverse(polygon.tags.begin(), polygon.tags.end());
  std::rotate(polygon.tags.begin(), polygon.tags.begin() + 1, polygon.tags.end());
}

/// Element size of the fluid: small at some edges and in some boxes, growing away from them.
class FluidSize {
public:
  FluidSize(double largest, double growth) : largest_(largest), growth_(growth) {}

  void at_edges(const std::vector<Point<2>>& loop, double size) {
    for (std::size_t i = 0; i < loop.size(); ++i) at_edge(loop[i], loop[(i + 1) % loop.size()], size);
  }
  void at_edge(const Point<2>& a, const Point<2>& b, double size) {
    if (size > 0) edges_.push_back({a, b, size});
  }
  void in_box(const RefinementBox<2>& box) { boxes_.push_back(box); }

  double operator()(const Point<2>& x) const {
    double size = largest_;
    for (const auto& edge : edges_)
      size = std::min(size, edge.size + growth_ * distance_to_segment<2>(edge.a, edge.b, x));
    for (const auto& box : boxes_) size = std::min(size, size_about(box, growth_, x));
    return size;
  }

private:
  struct SizedEdge {
    Point<2> a, b;
    double size;
  };
  double largest_, growth_;
  std::vector<SizedEdge> edges_;
  std::vector<RefinementBox<2>> boxes_;
};

int tag_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

SimplexMesh<2> domain_mesh(const ProblemStatement& problem, bool axisymmetric) {
  const auto& domain = problem.domain;
  if (domain.shape.outline.empty() && domain.shape.radius == 0) return {};
  const auto size_at = [&](const std::string& boundary) {
    const auto found = problem.boundaries.find(boundary);
    const double size = found == problem.boundaries.end() ? 0.0 : found->second.size;
    return size > 0 ? std::min(size, domain.size) : domain.size;
  };
  TaggedPolygon polygon;
  polygon.points = corners_of(domain.shape, size_at(domain.sides.front()));
  for (std::size_t i = 0; i < polygon.points.size(); ++i)
    polygon.tags.push_back(tag_of(polygon.names, domain.sides[domain.shape.radius > 0 ? 0 : i]));
  orient(polygon);
  FluidSize size(domain.size, domain.growth);
  for (std::size_t i = 0; i < polygon.points.size(); ++i)
    size.at_edge(polygon.points[i], polygon.points[(i + 1) % polygon.points.size()],
                 size_at(polygon.names[polygon.tags[i]]));
  for (const auto& [name, hole] : problem.holes) {
    polygon.holes.push_back({corners_of(hole.shape, size_at(name)), tag_of(polygon.names, name)});
    size.at_edges(polygon.holes.back().points, size_at(name));
  }
  for (const auto& [name, body] : problem.bodies) {
    const double wanted = body.fluid_size > 0 ? body.fluid_size : domain.size;
    size.at_edges(corners_of(body.shape, wanted, axisymmetric), body.fluid_size);
    if (body.shape.inner_radius > 0)
      size.at_edges(circle(body.shape.centre, body.shape.inner_radius, wanted), body.fluid_size);
  }
  for (const auto& box : refinement_boxes(problem)) size.in_box(box);
  return mesh_polygon(polygon, size, min_angle);
}

SimplexMesh<2> body_mesh(const BodyStatement& body, bool axisymmetric) {
  TaggedPolygon polygon;
  polygon.names = {"skin"};
  polygon.points = corners_of(body.shape, body.size, axisymmetric);
  polygon.tags.assign(polygon.points.size(), 0);
  orient(polygon);
  if (body.shape.inner_radius > 0)
    polygon.holes.push_back({circle(body.shape.centre, body.shape.inner_radius, body.size), 0});
  if (body.line.size() > 1) {
    polygon.inner_paths.emplace_back();
    for (const auto& corner : body.line) polygon.inner_paths.back().push_back(point_of(corner));
  }
  const double size = body.size;
  return mesh_polygon(
      polygon, [size](const Point<2>&) { return size; }, min_angle);
}

/// Functions made of the expressions of one scene.
class Functions {
public:
  explicit Functions(const Scene& scene) : scene_(scene) {}

  Expression expression(const std::string& text, const std::string& where) const {
    return {text, scene_.space, scene_.problem.constants, where};
  }
  /// Empty for expressions that are left out; `cgs_per_unit` times their value.
  VectorField<2> vector(const std::array<std::string, 2>& texts, double cgs_per_unit,
                        const std::string& where) const {
    if (texts[0].empty()) return {};
    return [first = expression(texts[0], where), second = expression(texts[1], where), cgs_per_unit](
               const Point<2>& x, double t) -> Point<2> {
      const double a = units::length_to_mm(x[0]), b = units::length_to_mm(x[1]);
      return cgs_per_unit * Point<2>(first(a, b, t), second(a, b, t));
    };
  }
  TimeFunction time(const std::string& text, double cgs_per_unit, const std::string& where) const {
    if (text.empty()) return {};
    return
        [value = expression(text, where), cgs_per_unit](double t) { return cgs_per_unit * value(0, 0, t); };
  }
  std::function<bool(const Point<2>&)> region(const std::string& text, const std::string& where) const {
    if (text.empty()) return {};
    return [value = expression(text, where)](const Point<2>& x) {
      return value(units::length_to_mm(x[0]), units::length_to_mm(x[1]), 0) != 0;
    };
  }

private:
  const Scene& scene_;
};

BoundaryCondition<2> condition_of(const BoundaryStatement& statement, const Functions& functions,
                                  const std::string& where) {
  using Kind = BoundaryStatement::Kind;
  BoundaryCondition<2> condition;
  switch (statement.kind) {
    case Kind::wall:
      break;
    case Kind::velocity:
      condition.velocity = functions.vector(statement.velocity, 1, where);
      break;
    case Kind::symmetry:
      condition.kind = BoundaryCondition<2>::Kind::symmetry;
      break;
    case Kind::opening:
      condition.kind = BoundaryCondition<2>::Kind::opening;
      condition.pressure = functions.time(statement.pressure, units::dyn_per_cm2_per_mmHg, where);
      condition.tangential_zero = statement.tangential == BoundaryStatement::Tangential::zero;
      switch (statement.stress) {
        case BoundaryStatement::Stress::total_pressure:
          condition.opening = OpeningCondition::total_pressure;
          break;
        case BoundaryStatement::Stress::static_pressure:
          condition.opening = OpeningCondition::static_pressure;
          break;
        case BoundaryStatement::Stress::traction:
          condition.opening = OpeningCondition::traction;
          break;
      }
      break;
  }
  return condition;
}

/// Components of a velocity vanish along coordinate axes only.
void check_alignment(const SimplexMesh<2>& mesh, const BoundaryStatement& statement, const std::string& name,
                     const std::string& where) {
  using Kind = BoundaryStatement::Kind;
  const bool aligned_needed =
      statement.kind == Kind::symmetry ||
      (statement.kind == Kind::opening && statement.tangential == BoundaryStatement::Tangential::zero);
  if (!aligned_needed) return;
  for (const auto& facet : mesh.boundary) {
    if (mesh.boundary_names[facet.tag] != name) continue;
    const Point<2> edge = (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).cwiseAbs();
    if (edge.minCoeff() > 1e-9 * edge.maxCoeff())
      throw InputError("a condition on the normal velocity needs a side along a coordinate axis",
                       "side \"" + name + "\" is inclined",
                       "sides of constant x or y (r or z); openings may state tangential = \"free\"", where);
  }
}

SolidModel model_of(BodyStatement::Law law) {
  switch (law) {
    case BodyStatement::Law::linear:
      return SolidModel::linear;
    case BodyStatement::Law::saint_venant_kirchhoff:
      return SolidModel::saint_venant_kirchhoff;
    case BodyStatement::Law::neo_hookean:
      return SolidModel::neo_hookean;
  }
  return SolidModel::linear;
}

SolidBody<2> body_of(const std::string& name, const BodyStatement& statement, bool axisymmetric,
                     const Functions& functions, const std::string& where) {
  SolidBody<2> body;
  body.name = name;
  body.mesh = body_mesh(statement, axisymmetric);
  body.properties = {statement.density,      statement.young,        statement.poisson,
                     statement.damping_time, statement.mass_damping, statement.stiffness_damping};
  body.model = model_of(statement.law);
  body.imposed = functions.region(statement.held, where + " \"held\"");
  body.imposed_displacement =
      functions.vector(statement.displacement, units::cm_per_mm, where + " \"displacement_mm\"");
  body.body_force = functions.vector(statement.body_force, 1, where + " \"body_force_dyn_per_cm3\"");
  body.initial_velocity = functions.vector(statement.velocity, 1, where + " \"velocity_cm_per_s\"");
  const bool held =
      body.imposed && std::all_of(body.mesh.points.begin(), body.mesh.points.end(), body.imposed);
  if (!held && (statement.density == 0 || statement.young == 0))
    throw InputError("a body that may deform needs a density and a stiffness",
                     "density_g_per_cm3 = " + exact_number(statement.density) +
                         ", young_dyn_per_cm2 = " + exact_number(statement.young),
                     "both > 0, or held = \"1\"", where);
  if (body.imposed && std::none_of(body.mesh.points.begin(), body.mesh.points.end(), body.imposed))
    throw InputError("no point of the body is held", "held = \"" + statement.held + "\"",
                     "a region (mm) that contains points of its mesh; leave the key out for a free body",
                     where);
  return body;
}

} // namespace

FsiProblem<2> general_problem(const Scene& scene) {
  const ProblemStatement& statement = scene.problem;
  const Functions functions(scene);
  auto problem = problem_without_meshes(scene);
  problem.body_force = functions.vector(statement.body_force, 1, scene.file.string() + ", section [domain]");
  const bool axisymmetric = scene.space == Space::axisymmetric;
  problem.background = domain_mesh(statement, axisymmetric);
  problem.pin_pressure = true;
  for (const auto& name : problem.background.boundary_names) {
    const auto found = statement.boundaries.find(name);
    const BoundaryStatement wall;
    const BoundaryStatement& stated = found == statement.boundaries.end() ? wall : found->second;
    const std::string where = scene.file.string() + ", section [boundary." + name + "]";
    check_alignment(problem.background, stated, name, where);
    problem.boundary.emplace(name, condition_of(stated, functions, where));
    if (stated.kind == BoundaryStatement::Kind::opening) problem.pin_pressure = false;
  }
  for (const auto& [name, body] : statement.bodies)
    problem.solids.push_back(
        body_of(name, body, axisymmetric, functions, scene.file.string() + ", section [body." + name + "]"));
  return problem;
}

} // namespace undula::fom
