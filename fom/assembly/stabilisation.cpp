#include "fom/assembly/facet_patch.hpp"
#include "fom/assembly/velocity_jump.hpp"

namespace undula::fom {

double phi_weight(const StabilisationWeights& weights, const FluidProperties& fluid, double h) {
  return fluid.viscosity + fluid.density * (weights.reference_velocity * h + h * h / weights.reference_time);
}

namespace {

/// Of a jump of the second derivative against one of the first, times h^2: the share of the second term of a
/// Taylor series, squared.
constexpr double second_derivative_part = 0.25;

/// Calls f(connection, patch, area with the measure) for the facets of the share.
template <int dim, class F>
void for_each_patch(const Discretisation<dim>& disc, const Share& share,
                    std::span<const PartGeometry<dim>> geometries, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& connection : disc.cut.connections) {
    const int first = connection.part[0], second = connection.part[1];
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[first][0], 0))) continue;
    if (geometries[first].weight == 0) continue;
    const auto patch = facet_patch(disc, connection, geometries[first], geometries[second]);
    f(connection, patch, patch.area * measure(patch.centre[0])); // r is linear: its mean is at the centre
  }
}

template <int dim>
bool jumps_scale_with_the_flow(const FsiProblem<dim>& problem) {
  return problem.flow == FlowModel::navier_stokes &&
         problem.stabilisation.velocity_scale == VelocityScale::local &&
         problem.stabilisation.velocity_jump > 0;
}

/// Weights of the squared jumps at a facet, but for its area.
struct JumpWeights {
  double normal = 0;        ///< of the velocity's first derivative along the normal
  double second_normal = 0; ///< of its second
  double divergence = 0;
};

template <int dim, class Forms, class Gradients, class Nodes>
void add_velocity_jump(const Discretisation<dim>& disc, const Nodes& nodes, const Gradients& gradient_jump,
                       const Forms& normal_jump, const Forms* second_jump, const JumpWeights& weights,
                       double area, Triplets& out) {
  const int count = static_cast<int>(nodes.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      double along = weights.normal * area * (normal_jump[i] * normal_jump[j]);
      if (second_jump) along += weights.second_normal * area * (*second_jump)[i] * (*second_jump)[j];
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d) {
          if (c != d && weights.divergence == 0) continue;
          double value = weights.divergence * area * gradient_jump(c, i) * gradient_jump(d, j);
          if (c == d) value += along;
          out.emplace_back(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], d), value);
        }
    }
}

} // namespace

template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share,
                             std::span<const PartGeometry<dim>> geometries, Triplets& out) {
  const auto& w = disc.problem.stabilisation;
  const auto& fluid = disc.problem.fluid;
  const bool everywhere = w.velocity_scale == VelocityScale::reference;
  const bool quadratic = disc.problem.velocity_order == 2;
  const Measure measure = measure_of(disc.problem.space);
  // The whole facet, also where a solid covers a piece of it: the extension of the polynomial is penalised.
  for_each_patch(
      disc, share, geometries, [&](const auto& connection, const FacetPatch<dim>& patch, double area) {
        const double h = patch.size, phi = phi_weight(w, fluid, h);
        const double inertia = fluid.density / w.reference_time;
        JumpWeights velocity;
        velocity.normal = everywhere ? w.velocity_jump * fluid.density * w.reference_velocity * h * h : 0.0;
        double pressure = w.pressure_jump * h * h * h / phi;
        velocity.divergence = w.divergence * phi * h;
        if (patch.cut) {
          const double ghost = w.ghost_viscous * fluid.viscosity * h + w.ghost_inertial * inertia * h * h * h;
          velocity.normal += ghost;
          velocity.second_normal = ghost * h * h * second_derivative_part;
          pressure += w.ghost_pressure * h * h * h / phi;
        }
        if (pressure > 0)
          for (int i = 0; i < dim + 2; ++i)
            for (int j = 0; j < dim + 2; ++j)
              out.emplace_back(disc.pressure_unknown(patch.nodes[i]), disc.pressure_unknown(patch.nodes[j]),
                               pressure * area * patch.normal_jump[i] * patch.normal_jump[j]);
        if (!quadratic) {
          add_velocity_jump(disc, patch.nodes, patch.gradient_jump, patch.normal_jump,
                            static_cast<const decltype(patch.normal_jump)*>(nullptr), velocity, area, out);
          return;
        }
        // Jumps that the flow scales need their places in the pattern.
        if (velocity.normal == 0 && velocity.divergence == 0 && !jumps_scale_with_the_flow(disc.problem))
          return;
        const auto both = quadratic_patch(disc, connection, patch, geometries[connection.part[0]],
                                          geometries[connection.part[1]]);
        for (int q = 0; q < QuadraticPatch<dim>::points; ++q)
          add_velocity_jump(disc, both.nodes, both.gradient_jump[q], both.normal_jump[q], &both.second_jump,
                            velocity, patch.area * measure(both.radius[q]) / QuadraticPatch<dim>::points,
                            out);
      });
}

template <int dim>
VelocityJumps<dim> velocity_jumps(const Discretisation<dim>& disc, const Share& share,
                                  std::span<const PartGeometry<dim>> geometries) {
  const double weight = disc.problem.stabilisation.velocity_jump * disc.problem.fluid.density;
  const bool quadratic = disc.problem.velocity_order == 2;
  const Measure measure = measure_of(disc.problem.space);
  VelocityJumps<dim> jumps;
  if (!jumps_scale_with_the_flow(disc.problem)) return jumps;
  if (quadratic)
    jumps.quadratic.reserve(disc.cut.connections.size());
  else
    jumps.linear.reserve(disc.cut.connections.size());
  for_each_patch(disc, share, geometries,
                 [&](const FacetConnection& connection, const FacetPatch<dim>& patch, double area) {
                   const double by_area = weight * patch.size * patch.size;
                   if (!quadratic) {
                     jumps.linear.push_back({patch.nodes, patch.normal_jump, patch.normal, patch.opposite,
                                             connection.part[0], by_area * area});
                     return;
                   }
                   QuadraticVelocityJump<dim> jump;
                   const auto both = quadratic_patch(disc, connection, patch, geometries[connection.part[0]],
                                                     geometries[connection.part[1]]);
                   jump.nodes = both.nodes;
                   jump.normal_jump = both.normal_jump;
                   jump.lambda = both.lambda;
                   jump.normal = patch.normal;
                   jump.part = connection.part[0];
                   for (int q = 0; q < QuadraticPatch<dim>::points; ++q)
                     jump.weight[q] =
                         by_area * patch.area * measure(both.radius[q]) / QuadraticPatch<dim>::points;
                   jumps.quadratic.push_back(std::move(jump));
                 });
  return jumps;
}

template void add_fluid_stabilisation(const Discretisation<2>&, const Share&,
                                      std::span<const PartGeometry<2>>, Triplets&);
template VelocityJumps<2> velocity_jumps(const Discretisation<2>&, const Share&,
                                         std::span<const PartGeometry<2>>);

template void add_fluid_stabilisation(const Discretisation<3>&, const Share&,
                                      std::span<const PartGeometry<3>>, Triplets&);
template VelocityJumps<3> velocity_jumps(const Discretisation<3>&, const Share&,
                                         std::span<const PartGeometry<3>>);

} // namespace undula::fom
