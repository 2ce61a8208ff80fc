#include "fom/assembly/forms.hpp"

namespace undula {

double phi_weight(const StabilisationWeights& weights, const FluidProperties& fluid, double h) {
  return fluid.viscosity + fluid.density * (weights.reference_velocity * h + h * h / weights.reference_time);
}

template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share, Triplets& out) {
  const auto& w = disc.problem.stabilisation;
  const auto& fluid = disc.problem.fluid;
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& connection : disc.cut.connections) {
    const auto& facet = disc.cut.facets.facets[connection.facet];
    const auto& first_nodes = disc.fluid_nodes.part_dofs[connection.part[0]];
    if (!share.has(disc.velocity_unknown(first_nodes[0], 0))) continue;

    // Jump of the normal derivative as a linear form on the nodes of both parts; a shared node appears twice
    // and its two contributions add up in the compressed matrix.
    std::array<int, 2 * (dim + 1)> nodes;
    Eigen::Matrix<double, dim, 2 * (dim + 1)> gradient_jump;
    double h = 0;
    bool touches_cut = false;
    for (int side = 0; side < 2; ++side) {
      const int part = connection.part[side];
      const int cell = disc.cut.parts[part].cell;
      const auto g = barycentric_gradients(disc.cut.mesh, cell);
      for (int a = 0; a <= dim; ++a) {
        nodes[side * (dim + 1) + a] = disc.fluid_nodes.part_dofs[part][a];
        gradient_jump.col(side * (dim + 1) + a) = (side == 0 ? 1.0 : -1.0) * g.col(a);
      }
      h = std::max(h, cell_diameter(disc.cut.mesh, cell));
      touches_cut = touches_cut || disc.cut.parts[part].cut;
    }
    const int cell0 = disc.cut.parts[connection.part[0]].cell;
    const int local0 = facet.cells[0] == cell0 ? facet.local[0] : facet.local[1];
    const Point<dim> normal = barycentric_gradients(disc.cut.mesh, cell0).col(local0).normalized();

    // The whole facet, also where a solid covers a piece of it: the extension of the polynomial is penalised.
    double area = 0;
    {
      Point<dim> centre = Point<dim>::Zero();
      for (const int p : facet.points) centre += disc.cut.mesh.points[p] / dim;
      const double simplex = dim * cell_measure(disc.cut.mesh, cell0) *
                             barycentric_gradients(disc.cut.mesh, cell0).col(local0).norm();
      area = simplex * measure(centre[0]); // r is linear: its mean is at the centre
    }
    const double phi = phi_weight(w, fluid, h);
    const double inertia = fluid.density / w.reference_time;
    double velocity = w.velocity_jump * fluid.density * w.reference_velocity * h * h;
    double pressure = w.pressure_jump * h * h * h / phi;
    const double divergence = w.divergence * phi * h;
    if (touches_cut) {
      velocity += w.ghost_viscous * fluid.viscosity * h + w.ghost_inertial * inertia * h * h * h;
      pressure += w.ghost_pressure * h * h * h / phi;
    }
    const Eigen::Matrix<double, 2 * (dim + 1), 1> normal_jump = gradient_jump.transpose() * normal;
    for (int i = 0; i < 2 * (dim + 1); ++i)
      for (int j = 0; j < 2 * (dim + 1); ++j) {
        const double normal_product = area * normal_jump[i] * normal_jump[j];
        out.emplace_back(disc.pressure_unknown(nodes[i]), disc.pressure_unknown(nodes[j]),
                         pressure * normal_product);
        for (int c = 0; c < dim; ++c) {
          const int row = disc.velocity_unknown(nodes[i], c);
          out.emplace_back(row, disc.velocity_unknown(nodes[j], c), velocity * normal_product);
          for (int d = 0; d < dim; ++d)
            out.emplace_back(row, disc.velocity_unknown(nodes[j], d),
                             divergence * area * gradient_jump(c, i) * gradient_jump(d, j));
        }
      }
  }
}

template void add_fluid_stabilisation(const Discretisation<2>&, const Share&, Triplets&);

} // namespace undula
