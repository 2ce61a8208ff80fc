#include "fom/scene/statement_checks.hpp"

#include <cmath>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/key_place.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/skin_statement.hpp"
#include "fom/scene/statement_geometry.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

std::string listed(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + in_quotes(name);
  }
  return text.empty() ? "none" : text;
}

void check_shape(const ShapeStatement& shape, const std::string& where) {
  const bool polygon = !shape.outline.empty();
  if (polygon == (shape.radius > 0)) {
    throw InputError("the shape is not stated in exactly one way",
                     polygon ? "both an outline and a radius" : "neither an outline nor a radius",
                     "either \"outline_mm\", or \"radius_mm\" > 0 with \"centre_mm\"", where);
  }
  if (polygon && shape.outline.size() < 3) {
    throw InputError("an outline has too few corners", std::to_string(shape.outline.size()), "3 or more",
                     where);
  }
  if (shape.inner_radius > 0 && shape.inner_radius >= shape.radius) {
    throw InputError("an annulus is turned inside out",
                     "inner radius " + shortest_number(shape.inner_radius) + " cm, radius " +
                         shortest_number(shape.radius) + " cm",
                     "inner_radius_mm < radius_mm", where);
  }
}

void check_domain(const ProblemStatement& problem, const std::string& where) {
  const DomainStatement& domain = problem.domain;
  const std::string at = where + ", section [domain]";
  if (!has_fluid(domain)) {
    if (!problem.holes.empty() || !problem.boundaries.empty() || !domain.sides.empty()) {
      throw InputError("holes and boundaries need a domain", "no shape of the fluid's domain",
                       "\"outline_mm\" or \"radius_mm\"", at);
    }
    return;
  }
  check_shape(domain.shape, at);
  const std::size_t sides = domain.shape.radius > 0 ? 1 : domain.shape.outline.size();
  if (domain.sides.size() != sides) {
    throw InputError("the sides of the domain are not all named",
                     std::to_string(domain.sides.size()) + " names",
                     std::to_string(sides) + ", one for the way from each corner to the next", at);
  }
  if (domain.size == 0) {
    throw InputError("the fluid has no element size", "size_mm = 0", "\"domain.size_mm\" > 0", at);
  }
  for (const auto& [name, hole] : problem.holes) {
    check_shape(hole.shape, where + ", section [hole." + name + "]");
  }
}

/// Nothing that a scene says is left out silently.
void check_fluid_keys(const Scene& scene, const std::string& where) {
  if (has_fluid(scene.problem.domain)) return;
  for (const auto& [path, place] : scene.places)
    if (is_of_fluid(path))
      throw InputError("something is stated of a fluid, and there is none", in_quotes(path),
                       "a domain, \"domain.outline_mm\" or \"domain.radius_mm\"; or no such key",
                       place_of_key(scene, path, where));
}

void check_boundaries(const ProblemStatement& problem, const std::string& where) {
  const auto names = boundary_names(problem);
  for (const auto& [name, boundary] : problem.boundaries) {
    using Kind = BoundaryStatement::Kind;
    const std::string at = where + ", section [boundary." + name + "]";
    if (!names.contains(name)) {
      throw InputError("a condition belongs to no boundary", in_quotes(name),
                       "names in \"domain.sides\" and of holes: " + listed(names), at);
    }
    if ((boundary.kind == Kind::velocity) == boundary.velocity[0].empty()) {
      throw InputError("a velocity and the kind of the condition do not go together",
                       boundary.velocity[0].empty() ? "no \"velocity_cm_per_s\"" : "\"velocity_cm_per_s\"",
                       "kind = \"velocity\" with \"velocity_cm_per_s\", or neither", at);
    }
    if (boundary.kind != Kind::opening && !boundary.pressure.empty()) {
      throw InputError("a pressure stands at a boundary that is no opening", "\"pressure_mmHg\"",
                       "kind = \"opening\"", at);
    }
  }
}

void check_bodies(const ProblemStatement& problem, const std::string& where) {
  for (const auto& [name, body] : problem.bodies) {
    const std::string at = where + ", section [body." + name + "]";
    check_shape(body.shape, at);
    if (body.damping_time > 0 && body.stiffness_damping > 0) {
      throw InputError("damping in proportion to the stiffness is stated twice",
                       "damping_time_s = " + shortest_number(body.damping_time) +
                           ", stiffness_damping_s = " + shortest_number(body.stiffness_damping),
                       "one of them", at);
    }
    if (!body.displacement[0].empty() && body.held.empty()) {
      throw InputError("a displacement is imposed nowhere", "\"displacement_mm\" without \"held\"",
                       "held = \"1\" for the whole body", at);
    }
    if (problem.holes.contains(name)) {
      throw InputError("a body and a hole share a name", in_quotes(name), "names of their own", at);
    }
  }
}

void check_observed(const ProblemStatement& problem, const std::string& where) {
  const auto boundaries = boundary_names(problem);
  for (const auto& [name, force] : problem.forces) {
    const std::string at = where + ", section [force." + name + "]";
    auto known = boundaries;
    for (const auto& [body, statement] : problem.bodies) {
      known.insert(body);
    }
    if (force.on.empty()) {
      throw InputError("a force acts on nothing", "on = []", "some of " + listed(known), at);
    }
    for (const std::string& target : force.on) {
      if (!known.contains(target)) {
        throw InputError("a force acts on something unknown", in_quotes(target), listed(known), at);
      }
      const auto boundary = problem.boundaries.find(target);
      if (boundary != problem.boundaries.end() &&
          (boundary->second.kind == BoundaryStatement::Kind::opening ||
           boundary->second.kind == BoundaryStatement::Kind::symmetry)) {
        throw InputError("a force is asked for where no velocity is imposed", in_quotes(target),
                         "walls, boundaries of kind \"velocity\" and bodies", at);
      }
    }
  }
  for (const auto& [name, point] : problem.points) {
    const std::string at = where + ", section [point." + name + "]";
    if (!point.body.empty() && !problem.bodies.contains(point.body)) {
      std::set<std::string> known;
      for (const auto& [body, statement] : problem.bodies) {
        known.insert(body);
      }
      throw InputError("a point belongs to an unknown body", in_quotes(point.body), listed(known), at);
    }
    if (point.body.empty() && boundaries.empty()) {
      throw InputError("a point of the fluid without a fluid", in_quotes(name),
                       "\"body\", the name of a body", at);
    }
  }
}

} // namespace

void check_refinements(const Scene& scene, const std::string& where) {
  for (const auto& [name, box] : scene.problem.refinements) {
    const std::string at = where + ", section [refine." + name + "]";
    if (box.box.size() != 2 || box.box[0][0] > box.box[1][0] || box.box[0][1] > box.box[1][1]) {
      throw InputError("a box of refinement is not one", std::to_string(box.box.size()) + " points",
                       "two points, the lowest and the highest corner", at);
    }
    if (!box.body.empty() && !scene.problem.bodies.contains(box.body)) {
      throw InputError(
          "a box refines an unknown body", in_quotes(box.body),
          scene.problem.general ? "the name of a [body.NAME]" : "no such key: a pump has no bodies",
          place_of_key(scene, "refine." + name + ".body", where));
    }
    if (scene.problem.general && box.body.empty() && !has_fluid(scene.problem.domain)) {
      throw InputError("a box refines the fluid, and there is none", "[refine." + name + "] without \"body\"",
                       "\"body\", or a domain", at);
    }
    const bool no_mesh = scene.space == Space::thin_gap || scene.space == Space::long_wave;
    if (!scene.problem.general && (scene.profile.empty() || no_mesh)) {
      throw InputError("there is no mesh to refine in a box",
                       scene.space == Space::long_wave  ? "space = \"long-wave\""
                       : scene.space == Space::thin_gap ? "space = \"thin-gap\""
                                                        : "meshes from files",
                       "scenes with \"geometry.profile\" or [domain] and finite elements", at);
    }
  }
}

std::set<std::string> boundary_names(const ProblemStatement& problem) {
  std::set<std::string> names(problem.domain.sides.begin(), problem.domain.sides.end());
  for (const auto& [name, hole] : problem.holes) {
    names.insert(name);
  }
  return names;
}

void check_statement(const Scene& scene, const std::string& where) {
  if (scene.space == Space::thin_gap || scene.space == Space::long_wave) {
    throw InputError("the space does not go with a general problem",
                     scene.space == Space::thin_gap ? "space = \"thin-gap\"" : "space = \"long-wave\"",
                     "\"plane\" or \"axisymmetric\"", where + ", section [model]");
  }
  check_domain(scene.problem, where);
  check_fluid_keys(scene, where);
  check_boundaries(scene.problem, where);
  check_bodies(scene.problem, where);
  check_observed(scene.problem, where);
  check_skin_statement(scene, where);
  if (scene.time.end < scene.time.step) {
    throw InputError("the run ends before its first step", "end_s = " + shortest_number(scene.time.end),
                     "at least step_s = " + shortest_number(scene.time.step),
                     place_of_key(scene, "time.end_s", where));
  }
  if (const double steps = scene.time.end / scene.time.step; !(steps <= most_steps)) {
    throw InputError("the run has too many time steps",
                     shortest_number(std::round(steps)) + " steps, end_s = " +
                         shortest_number(scene.time.end) + ", step_s = " + shortest_number(scene.time.step),
                     "at most " + std::to_string(most_steps) + ", by a larger step or an earlier end",
                     place_of_key(scene, "time.step_s", where));
  }
  if (scene.output.statistics_from >= scene.time.end) {
    throw InputError("the window of the statistics begins after the run",
                     "statistics_from_s = " + shortest_number(scene.output.statistics_from),
                     "less than end_s = " + shortest_number(scene.time.end),
                     place_of_key(scene, "output.statistics_from_s", where));
  }
  check_statement_geometry(scene, where);
}

} // namespace undula::fom
