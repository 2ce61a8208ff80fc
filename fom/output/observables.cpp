#include "fom/output/observables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "fom/fom.hpp"
#include "fom/scene/operating_point.hpp"
#include "geometry/mesh/innermost_cell.hpp"
#include "geometry/mesh/polygons.hpp"

namespace undula::fom {

namespace {

/// Lowest and highest point of a mesh on the line x = r.
std::pair<double, double> extent_at(const SimplexMesh<2>& mesh, double r) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& facet : mesh.boundary) {
    const auto &a = mesh.points[facet.points[0]], &b = mesh.points[facet.points[1]];
    if ((a[0] - r) * (b[0] - r) > 0) continue;
    for (const double z : {a[0] == b[0] ? a[1] : a[1] + (b[1] - a[1]) * (r - a[0]) / (b[0] - a[0]),
                           a[0] == b[0] ? b[1] : a[1] + (b[1] - a[1]) * (r - a[0]) / (b[0] - a[0])}) {
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  return {low, high};
}

struct Clearance {
  double smallest = 0;                                        ///< cm
  double elements = std::numeric_limits<double>::quiet_NaN(); ///< across it
};

Clearance clearance(const ObservationPlan<2>& plan, const Eigen::VectorXd& d, int solid_unknowns) {
  Clearance least;
  if (plan.walls.empty() || plan.skin_unknowns.empty()) return least;
  const Eigen::VectorXd moved = d.tail(solid_unknowns);
  least.smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < plan.skin_unknowns.size(); ++i) {
    const Point<2> x = plan.skin_positions[i] + moved.segment<2>(plan.skin_unknowns[i]);
    double nearest = std::numeric_limits<double>::infinity(), height = 1;
    for (const auto& wall : plan.walls) {
      const double distance = distance_to_segment<2>(wall.points[0], wall.points[1], x);
      if (distance >= nearest) continue;
      nearest = distance;
      height = wall.height;
    }
    const double gap = inside_outline(plan.outline, x) ? nearest : -nearest;
    if (gap >= least.smallest) continue;
    least = {gap, std::max(gap, 0.0) / height};
  }
  return least;
}

struct WallShear {
  double maximum = 0, mean = 0;
  std::vector<double> by_wall;
};

WallShear wall_shear(const Discretisation<2>& disc, const Operators<2>& operators,
                     const ObservationPlan<2>& plan, const Eigen::VectorXd& x) {
  WallShear shear;
  shear.by_wall.assign(plan.walls.size(), 0.0);
  double area = 0;
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& piece : disc.cut.boundary) {
    const auto& condition = disc.problem.boundary.at(disc.problem.background.boundary_names[piece.tag]);
    if (condition.kind != BoundaryCondition<2>::Kind::velocity) continue;
    const auto& g = operators.geometries[piece.part].gradients;
    const Point<2> n = -g.col(disc.cut.facets.facets[piece.facet].local[0]).normalized();
    double& here = shear.by_wall[static_cast<std::size_t>(plan.wall_of_facet[piece.facet])];
    const int cell = disc.cut.parts[piece.part].cell;
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& at = disc.cut.boundary_quadrature.points[q];
      const Eigen::Matrix2d gradient =
          sample_velocity<2>(disc, piece.part, g, barycentric_coordinates(disc.cut.mesh, cell, at), x)
              .gradient;
      const Point<2> traction = disc.problem.fluid.viscosity * (gradient + gradient.transpose()) * n;
      const double tangential = (traction - traction.dot(n) * n).norm();
      shear.maximum = std::max(shear.maximum, tangential);
      here = std::max(here, tangential);
      const double w = disc.cut.boundary_quadrature.weights[q] * measure(at[0]);
      shear.mean += w * tangential;
      area += w;
    }
  }
  if (area > 0) shear.mean /= area;
  return shear;
}

} // namespace

template <int dim>
MembraneProbes membrane_probes(const Discretisation<dim>& disc, int count) {
  MembraneProbes probes;
  probes.axial.resize(count, disc.solid_unknowns());
  const auto& mesh = disc.problem.solids[0].mesh;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& x : mesh.points) {
    low = std::min(low, x[0]);
    high = std::max(high, x[0]);
  }
  Triplets entries;
  for (int k = 0; k < count; ++k) {
    // Slightly inside, so that a probe at either end has an interior point of the membrane above it.
    const double r = low + (high - low) * (1e-6 + (1 - 2e-6) * k / (count - 1.0));
    const auto [bottom, top] = extent_at(mesh, r);
    const Point<dim> x(r, 0.5 * (bottom + top));
    const int cell = innermost_cell(mesh, x);
    const auto shape = quadratic_values<dim>(barycentric_coordinates(mesh, cell, x));
    const auto& nodes = disc.solid_spaces[0].cell_nodes[cell];
    for (std::size_t i = 0; i < nodes.size(); ++i)
      entries.emplace_back(k, disc.solid_unknown(0, nodes[i], dim - 1) - disc.fluid_unknowns(), shape[i]);
    probes.radius.push_back(r);
  }
  probes.axial.setFromTriplets(entries.begin(), entries.end());
  return probes;
}

template <int dim>
ObservationPlan<dim> plan_observation(const Discretisation<dim>& disc, int probe_count) {
  ObservationPlan<dim> plan;
  if (!disc.problem.solids.empty() && probe_count > 0) plan.probes = membrane_probes(disc, probe_count);
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    std::set<int> skin;
    for (const auto& facet : disc.problem.solids[s].mesh.boundary)
      skin.insert(facet.points.begin(), facet.points.end());
    for (const int node : skin) {
      plan.skin_unknowns.push_back(disc.solid_unknown(static_cast<int>(s), node, 0) - disc.fluid_unknowns());
      plan.skin_positions.push_back(disc.solid_spaces[s].nodes[node]);
    }
  }
  for (const auto& facet : disc.problem.background.boundary) {
    std::array<Point<dim>, dim> simplex;
    for (int a = 0; a < dim; ++a) simplex[a] = disc.problem.background.points[facet.points[a]];
    plan.outline.push_back({simplex[0], simplex[1]});
  }
  plan.walls = boundary_walls(disc.problem);
  plan.wall_of_facet.assign(disc.cut.facets.facets.size(), -1);
  for (std::size_t w = 0; w < plan.walls.size(); ++w)
    plan.wall_of_facet[static_cast<std::size_t>(plan.walls[w].facet)] = static_cast<int>(w);
  return plan;
}

template <int dim>
Observation observe(const Discretisation<dim>& disc, const Operators<dim>& operators,
                    const TimeStepper<dim>& stepper, const ObservationPlan<dim>& plan, const State& state) {
  Observation seen;
  const auto& x = state.x[0];
  seen.step = state.step;
  seen.time = state.time;
  seen.solves = stepper.iterations();
  seen.convection_error = stepper.convection_error();
  if (const auto outlet = operators.openings.find(outlet_name); outlet != operators.openings.end()) {
    seen.outflow = outlet->second.dot(x);
    const auto& pressure = disc.problem.boundary.at(outlet_name).pressure;
    if (pressure) seen.hydraulic_power = pressure(state.time) * seen.outflow;
  }
  if (const auto inlet = operators.openings.find(inlet_name); inlet != operators.openings.end())
    seen.inflow = -inlet->second.dot(x);
  // What sums over all parts and cells is not known of a cubature.
  const bool whole = !disc.is_sampled();
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd residual;
  if (whole) {
    residual = stepper.residual(state);
    seen.general = observe_general(plan.general, disc, operators, residual, stepper.contact_reports(), state);
    seen.energy = stepper.energy(state, residual);
  } else {
    seen.energy = unknown_energy;
  }
  for (int node = 0; node < disc.velocity_nodes(); ++node)
    seen.speed_max = std::max(seen.speed_max, x.template segment<dim>(disc.velocity_unknown(node, 0)).norm());
  if (whole) {
    auto shear = wall_shear(disc, operators, plan, x);
    seen.wall_shear_max = shear.maximum;
    seen.wall_shear_mean = shear.mean;
    seen.wall_shear = std::move(shear.by_wall);
  } else {
    seen.wall_shear_max = seen.wall_shear_mean = unknown;
    seen.wall_shear.assign(plan.walls.size(), unknown);
  }
  if (plan.blood && whole) seen.blood = blood_stress(disc, *plan.blood, x);
  const auto least = clearance(plan, state.d[0], disc.solid_unknowns());
  seen.clearance_min = least.smallest;
  if (disc.interface_moves) seen.film_elements = least.elements;
  if (!plan.probes.radius.empty()) {
    const Eigen::VectorXd axial = plan.probes.axial_displacement(state.d[0]);
    seen.tip_displacement = axial[0];
    double force = whole ? 0 : unknown;
    if (whole)
      for (const auto& node : disc.imposed) force += residual[node.unknown + dim - 1];
    const auto& holder = disc.problem.holder;
    seen.holder =
        observe_holder(holder ? &holder->actuator : nullptr, holder ? holder->voltage(state.time) : 0,
                       axial[axial.size() - 1], plan.probes.axial_displacement(x)[axial.size() - 1], force);
  }
  return seen;
}

template MembraneProbes membrane_probes(const Discretisation<2>&, int);
template ObservationPlan<2> plan_observation(const Discretisation<2>&, int);
template Observation observe(const Discretisation<2>&, const Operators<2>&, const TimeStepper<2>&,
                             const ObservationPlan<2>&, const State&);

} // namespace undula::fom
