#include "fom/assembly/facet_patch.hpp"
#include "fom/assembly/velocity_jump.hpp"

namespace undula::fom {

double phi_weight(const StabilisationWeights& weights, const FluidProperties& fluid, double h) {
  return fluid.viscosity + fluid.density * (weights.reference_velocity * h + h * h / weights.reference_time);
}

namespace {

/// Calls f(connection, patch, area with the measure) for the facets of the share.
template <int dim, class F>
void for_each_patch(const Discretisation<dim>& disc, const Share& share,
                    std::span<const PartGeometry<dim>> geometries, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& connection : disc.cut.connections) {
    const int first = connection.part[0], second = connection.part[1];
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[first][0], 0))) continue;
    const auto patch = facet_patch(disc, connection, geometries[first], geometries[second]);
    f(connection, patch, patch.area * measure(patch.centre[0])); // r is linear: its mean is at the centre
  }
}

} // namespace

template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share,
                             std::span<const PartGeometry<dim>> geometries, Triplets& out) {
  const auto& w = disc.problem.stabilisation;
  const auto& fluid = disc.problem.fluid;
  const bool everywhere = w.velocity_scale == VelocityScale::reference;
  // The whole facet, also where a solid covers a piece of it: the extension of the polynomial is penalised.
  for_each_patch(disc, share, geometries, [&](const auto&, const FacetPatch<dim>& patch, double area) {
    const double h = patch.size, phi = phi_weight(w, fluid, h);
    const double inertia = fluid.density / w.reference_time;
    double velocity = everywhere ? w.velocity_jump * fluid.density * w.reference_velocity * h * h : 0.0;
    double pressure = w.pressure_jump * h * h * h / phi;
    const double divergence = w.divergence * phi * h * area;
    if (patch.cut) {
      velocity += w.ghost_viscous * fluid.viscosity * h + w.ghost_inertial * inertia * h * h * h;
      pressure += w.ghost_pressure * h * h * h / phi;
    }
    for (int i = 0; i < dim + 2; ++i)
      for (int j = 0; j < dim + 2; ++j) {
        const double normal_product = area * patch.normal_jump[i] * patch.normal_jump[j];
        out.emplace_back(disc.pressure_unknown(patch.nodes[i]), disc.pressure_unknown(patch.nodes[j]),
                         pressure * normal_product);
        for (int c = 0; c < dim; ++c) {
          const int row = disc.velocity_unknown(patch.nodes[i], c);
          for (int d = 0; d < dim; ++d) {
            double value = divergence * patch.gradient_jump(c, i) * patch.gradient_jump(d, j);
            if (c == d) value += velocity * normal_product;
            out.emplace_back(row, disc.velocity_unknown(patch.nodes[j], d), value);
          }
        }
      }
  });
}

template <int dim>
std::vector<VelocityJump<dim>> velocity_jumps(const Discretisation<dim>& disc, const Share& share,
                                              std::span<const PartGeometry<dim>> geometries) {
  const double weight = disc.problem.stabilisation.velocity_jump * disc.problem.fluid.density;
  std::vector<VelocityJump<dim>> jumps;
  jumps.reserve(disc.cut.connections.size());
  for_each_patch(disc, share, geometries,
                 [&](const FacetConnection& connection, const FacetPatch<dim>& patch, double area) {
                   jumps.push_back({patch.nodes, patch.normal_jump, patch.normal, patch.opposite,
                                    connection.part[0], weight * patch.size * patch.size * area});
                 });
  return jumps;
}

template void add_fluid_stabilisation(const Discretisation<2>&, const Share&,
                                      std::span<const PartGeometry<2>>, Triplets&);
template std::vector<VelocityJump<2>> velocity_jumps(const Discretisation<2>&, const Share&,
                                                     std::span<const PartGeometry<2>>);

} // namespace undula::fom
