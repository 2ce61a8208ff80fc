#include <algorithm>

#include "fom/assembly/forms.hpp"

namespace undula {

double phi_weight(const StabilisationWeights& weights, const FluidProperties& fluid, double h) {
  return fluid.viscosity + fluid.density * (weights.reference_velocity * h + h * h / weights.reference_time);
}

template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share,
                             std::span<const PartGeometry<dim>> geometries, Triplets& out) {
  const auto& w = disc.problem.stabilisation;
  const auto& fluid = disc.problem.fluid;
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& connection : disc.cut.connections) {
    const auto& facet = disc.cut.facets.facets[connection.facet];
    const auto& first_nodes = disc.fluid_nodes.part_dofs[connection.part[0]];
    if (!share.has(disc.velocity_unknown(first_nodes[0], 0))) continue;

    // Jump of the gradient as a linear form on the nodes of both parts; connected parts share those of the
    // facet.
    std::array<int, 2 * (dim + 1)> nodes;
    Eigen::Matrix<double, dim, 2 * (dim + 1)> gradient_jump =
        Eigen::Matrix<double, dim, 2 * (dim + 1)>::Zero();
    int count = 0;
    double h = 0, thinning = 0;
    bool touches_cut = false;
    for (int side = 0; side < 2; ++side) {
      const int part = connection.part[side];
      const int cell = disc.cut.parts[part].cell;
      const auto& geometry = geometries[part];
      for (int a = 0; a <= dim; ++a) {
        const int node = disc.fluid_nodes.part_dofs[part][a];
        const int at =
            static_cast<int>(std::find(nodes.begin(), nodes.begin() + count, node) - nodes.begin());
        if (at == count) nodes[count++] = node;
        gradient_jump.col(at) += (side == 0 ? 1.0 : -1.0) * geometry.gradients.col(a);
      }
      const int local = facet.local[facet.cells[0] == cell ? 0 : 1];
      h = std::max(h, cell_diameter(disc.cut.mesh, cell));
      thinning = std::max(
          thinning, geometry.reference_gradients.col(local).norm() / geometry.gradients.col(local).norm());
      touches_cut = touches_cut || disc.cut.parts[part].cut;
    }
    // The size that counts is the one across the facet: it changes as the heights of the two elements above
    // it do.
    h *= thinning;
    const int cell0 = disc.cut.parts[connection.part[0]].cell;
    const int local0 = facet.cells[0] == cell0 ? facet.local[0] : facet.local[1];
    const auto& geometry0 = geometries[connection.part[0]];
    const Point<dim> normal = geometry0.gradients.col(local0).normalized();

    // The whole facet, also where a solid covers a piece of it: the extension of the polynomial is penalised.
    Point<dim> centre = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a)
      if (a != local0) centre += geometry0.corners.col(a) / dim;
    const double simplex = dim * cell_measure(disc.cut.mesh, cell0) * geometry0.volume_ratio *
                           geometry0.gradients.col(local0).norm();
    const double area = simplex * measure(centre[0]); // r is linear: its mean is at the centre
    const double phi = phi_weight(w, fluid, h);
    const double inertia = fluid.density / w.reference_time;
    double velocity = w.velocity_jump * fluid.density * w.reference_velocity * h * h;
    double pressure = w.pressure_jump * h * h * h / phi;
    const double divergence = w.divergence * phi * h * area;
    if (touches_cut) {
      velocity += w.ghost_viscous * fluid.viscosity * h + w.ghost_inertial * inertia * h * h * h;
      pressure += w.ghost_pressure * h * h * h / phi;
    }
    const Eigen::Matrix<double, 2 * (dim + 1), 1> normal_jump = gradient_jump.transpose() * normal;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const double normal_product = area * normal_jump[i] * normal_jump[j];
        out.emplace_back(disc.pressure_unknown(nodes[i]), disc.pressure_unknown(nodes[j]),
                         pressure * normal_product);
        for (int c = 0; c < dim; ++c) {
          const int row = disc.velocity_unknown(nodes[i], c);
          for (int d = 0; d < dim; ++d) {
            double value = divergence * gradient_jump(c, i) * gradient_jump(d, j);
            if (c == d) value += velocity * normal_product;
            out.emplace_back(row, disc.velocity_unknown(nodes[j], d), value);
          }
        }
      }
  }
}

template void add_fluid_stabilisation(const Discretisation<2>&, const Share&,
                                      std::span<const PartGeometry<2>>, Triplets&);

} // namespace undula
