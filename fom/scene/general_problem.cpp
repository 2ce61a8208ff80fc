#include "fom/scene/general_problem.hpp"

#include <algorithm>
#include <cmath>

#include "fom/fom.hpp"
#include "fom/scene/body_size.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/fluid_size.hpp"
#include "fom/scene/scene_functions.hpp"
#include "fom/scene/scene_time.hpp"
#include "fom/scene/shape_outline.hpp"
#include "fom/scene/skin_statement.hpp"
#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/polygons.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double min_angle = 25; ///< degrees, of the meshes

SimplexMesh<2> domain_mesh(const ProblemStatement& problem, bool axisymmetric) {
  const auto& domain = problem.domain;
  if (!has_fluid(domain)) return {};
  const TaggedPolygon polygon = domain_polygon(problem);
  const FluidSize size(problem, polygon, axisymmetric);
  return mesh_polygon(
      polygon, [&](const Point<2>& x) { return size(x); }, min_angle);
}

SimplexMesh<2> body_mesh(const ProblemStatement& problem, const std::string& name, bool axisymmetric) {
  const BodyStatement& body = problem.bodies.at(name);
  const BodySize size(problem, name);
  TaggedPolygon polygon;
  polygon.names = {"skin"};
  polygon.points = size.divided(body, body_corners(body, axisymmetric));
  if (polygon_area(polygon.points) < 0) std::reverse(polygon.points.begin(), polygon.points.end());
  polygon.tags.assign(polygon.points.size(), 0);
  if (body.shape.inner_radius > 0)
    polygon.holes.push_back(
        {size.divided(body, circle(body.shape.centre, body.shape.inner_radius, body.size)), 0});
  if (body.line.size() > 1) {
    polygon.inner_paths.emplace_back();
    for (const auto& corner : body.line) polygon.inner_paths.back().push_back(point_of(corner));
  }
  return mesh_polygon(
      polygon, [&](const Point<2>& x) { return size(x); }, min_angle);
}

BoundaryCondition<2> condition_of(const BoundaryStatement& statement, const SceneFunctions& functions,
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

SolidBody<2> body_of(const std::string& name, const ProblemStatement& problem, bool axisymmetric,
                     const SceneFunctions& functions, const std::string& where) {
  const BodyStatement& statement = problem.bodies.at(name);
  SolidBody<2> body;
  body.name = name;
  body.mesh = body_mesh(problem, name, axisymmetric);
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
  const SceneFunctions functions(scene);
  auto problem = problem_without_meshes(scene);
  problem.stabilisation = weights_in_force(scene, 0); // 0: nothing drives, see stated_speed
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
    problem.solids.push_back(body_of(name, statement, axisymmetric, functions,
                                     scene.file.string() + ", section [body." + name + "]"));
  add_skin_conditions(scene, problem);
  return problem;
}

} // namespace undula::fom
