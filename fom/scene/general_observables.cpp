#include "fom/scene/general_observables.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "fom/fom.hpp"
#include "fom/scene/expression.hpp"
#include "fom/space/velocity_element.hpp"
#include "fom/time/reaction.hpp"
#include "geometry/cut/part_lookup.hpp"
#include "geometry/mesh/innermost_cell.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double dyn_per_cm_per_N_per_m = 1000;
constexpr double dyn_per_mN = 100;
constexpr double erg_per_uJ = 10, erg_per_s_per_mW = 1e4;
constexpr double on_edge = 1e-9; ///< barycentric coordinates that count as zero

/// Velocity and pressure at x; none where there is no fluid.
std::optional<Eigen::Vector3d> fluid_at(const Discretisation<2>& disc, const Point<2>& x,
                                        const Eigen::VectorXd& values) {
  for (int part = 0; part < static_cast<int>(disc.cut.parts.size()); ++part) {
    const int cell = disc.cut.parts[part].cell;
    const auto lambda = barycentric_coordinates(disc.cut.mesh, cell, x);
    if (lambda.minCoeff() < -on_edge) continue;
    if (disc.cut.parts[part].cut && !part_contains<2>(disc.cut, part, x)) continue;
    const auto velocity =
        sample_velocity<2>(disc, part, barycentric_gradients(disc.cut.mesh, cell), lambda, values);
    Eigen::Vector3d value;
    value << velocity.value, sample_pressure<2>(disc, part, lambda, values);
    return value;
  }
  return std::nullopt;
}

SolidPoint solid_point(const Discretisation<2>& disc, int solid, const Point<2>& x,
                       const std::string& where) {
  const auto& mesh = disc.problem.solids[solid].mesh;
  const int cell = innermost_cell(mesh, x);
  const auto lambda = barycentric_coordinates(mesh, cell, x);
  // Round bodies are polygons: a point on the circle is a little outside.
  constexpr double outside = 0.05;
  if (lambda.minCoeff() < -outside)
    throw InputError("a point is outside of its body",
                     "(" + exact_number(units::length_to_mm(x[0])) + ", " +
                         exact_number(units::length_to_mm(x[1])) + ") mm",
                     "a point of body \"" + disc.problem.solids[solid].name + "\" at rest", where);
  const auto shape = quadratic_values<2>(lambda);
  const auto& nodes = disc.solid_spaces[solid].cell_nodes[cell];
  SolidPoint point;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    point.unknowns.push_back(disc.solid_unknown(solid, nodes[i], 0) - disc.fluid_unknowns());
    point.weights.push_back(shape[static_cast<Eigen::Index>(i)]);
  }
  return point;
}

int solid_named(const Discretisation<2>& disc, const std::string& name) {
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s)
    if (disc.problem.solids[s].name == name) return static_cast<int>(s);
  return -1;
}

} // namespace

GeneralObservables plan_general_observables(const Discretisation<2>& disc, const Scene& scene) {
  GeneralObservables plan;
  const bool axisymmetric = scene.space == Space::axisymmetric;
  const auto axes = expression_variables(scene.space);
  const auto add_column = [&](const std::string& name, double cgs_per_unit) {
    plan.columns.push_back({name, cgs_per_unit});
  };
  for (const auto& [name, condition] : disc.problem.boundary) {
    if (condition.kind != BoundaryCondition<2>::Kind::opening) continue;
    plan.openings.push_back(name);
    if (axisymmetric)
      add_column(name + "_outflow_l_per_min", units::cm3_per_s_per_l_per_min);
    else
      add_column(name + "_outflow_cm2_per_s", 1);
  }
  // The radial sum over a ring is no force.
  plan.components = axisymmetric ? std::vector<int>{1} : std::vector<int>{0, 1};
  for (const auto& [name, statement] : scene.problem.forces) {
    GeneralForce force;
    for (const auto& target : statement.on) {
      const int solid = solid_named(disc, target);
      if (solid >= 0)
        force.solids.push_back(solid);
      else
        force.boundaries.push_back(target);
    }
    plan.forces.push_back(std::move(force));
    for (const int component : plan.components) {
      const std::string axis = axes[static_cast<std::size_t>(component)];
      if (axisymmetric)
        add_column(name + "_force_" + axis + "_mN", dyn_per_mN);
      else
        add_column(name + "_force_" + axis + "_N_per_m", dyn_per_cm_per_N_per_m);
    }
  }
  // Pairs of the problem are in the order of their names, too.
  const std::string per_depth = axisymmetric ? "" : "_per_cm";
  plan.pairs = static_cast<int>(scene.problem.pairs.size());
  for (const auto& [name, statement] : scene.problem.pairs) {
    const std::string force_unit = axisymmetric ? "_mN" : "_N_per_m";
    const double dyn_per_unit = axisymmetric ? dyn_per_mN : dyn_per_cm_per_N_per_m;
    add_column(name + "_load" + force_unit, dyn_per_unit);
    for (const int component : plan.components)
      add_column(name + "_force_" + axes[static_cast<std::size_t>(component)] + force_unit, dyn_per_unit);
    add_column(name + "_pressure_max_dyn_per_cm2", 1);
    add_column(name + "_length_mm", units::cm_per_mm);
    add_column(name + "_penetration_mm", units::cm_per_mm);
    add_column(name + "_energy_uJ" + per_depth, erg_per_uJ);
    add_column(name + "_power_mW" + per_depth, erg_per_s_per_mW);
    add_column(name + "_friction_power_mW" + per_depth, erg_per_s_per_mW);
  }
  for (const auto& [name, statement] : scene.problem.points) {
    if (statement.body.empty()) continue;
    plan.solid_points.push_back(solid_point(disc, solid_named(disc, statement.body),
                                            Point<2>(statement.at[0], statement.at[1]),
                                            scene.file.string() + ", section [point." + name + "]"));
    for (int c = 0; c < 2; ++c) add_column(name + "_displacement_" + axes[c] + "_mm", units::cm_per_mm);
  }
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(disc.unknowns());
  for (const auto& [name, statement] : scene.problem.points) {
    if (!statement.body.empty()) continue;
    const Point<2> x(statement.at[0], statement.at[1]);
    if (!fluid_at(disc, x, nothing))
      throw InputError("a point to follow is not in the fluid",
                       "(" + exact_number(units::length_to_mm(x[0])) + ", " +
                           exact_number(units::length_to_mm(x[1])) + ") mm",
                       "a point of the domain outside of all bodies at rest, or \"body\"",
                       scene.file.string() + ", section [point." + name + "]");
    plan.fluid_points.push_back(x);
    add_column(name + "_pressure_mmHg", units::dyn_per_cm2_per_mmHg);
    for (int c = 0; c < 2; ++c) add_column(name + "_velocity_" + axes[c] + "_cm_per_s", 1);
  }
  return plan;
}

std::vector<double> observe_general(const GeneralObservables& plan, const Discretisation<2>& disc,
                                    const Operators<2>& operators, const Eigen::VectorXd& residual,
                                    std::span<const PairReport<2>> pairs, const State& state) {
  std::vector<double> values;
  const auto& x = state.x[0];
  for (const auto& name : plan.openings) values.push_back(operators.openings.at(name).dot(x));
  for (const auto& force : plan.forces) {
    Point<2> sum = Point<2>::Zero();
    for (const int solid : force.solids) sum += force_on_solid<2>(disc, operators, x, solid);
    for (const auto& name : force.boundaries) sum += force_on_boundary<2>(disc, residual, name);
    for (const int component : plan.components) values.push_back(sum[component]);
  }
  for (int p = 0; p < plan.pairs; ++p) {
    const auto& pair = pairs[static_cast<std::size_t>(p)];
    values.push_back(pair.load);
    for (const int component : plan.components) values.push_back(pair.force[component]);
    for (const double value :
         {pair.pressure, pair.length, pair.penetration, pair.energy, pair.power, pair.friction_power})
      values.push_back(value);
  }
  const Eigen::VectorXd solid_displacement = state.d[0].tail(disc.solid_unknowns());
  for (const auto& point : plan.solid_points) {
    Point<2> moved = Point<2>::Zero();
    for (std::size_t i = 0; i < point.unknowns.size(); ++i)
      moved += point.weights[i] * solid_displacement.segment<2>(point.unknowns[i]);
    values.insert(values.end(), moved.begin(), moved.end());
  }
  for (const auto& at : plan.fluid_points) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d value = fluid_at(disc, at, x).value_or(Eigen::Vector3d(nan, nan, nan));
    for (const int c : {2, 0, 1}) values.push_back(value[c]);
  }
  return values;
}

} // namespace undula::fom
