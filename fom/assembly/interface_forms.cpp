#include "fom/assembly/forms.hpp"

namespace undula {

namespace {

/// One basis function seen by the interface at a quadrature point: its part in the jump u - v_s (along one
/// component), in the viscous traction 2 mu eps n, and in the pressure.
template <int dim>
struct InterfaceBasis {
  int unknown;
  int component;       ///< of the jump; -1 for a pressure
  double jump;         ///< value of u - v_s along `component`
  Point<dim> traction; ///< 2 mu eps(basis) n, dyn/cm^2 per unit
  double pressure;     ///< value of the pressure
};

} // namespace

template <int dim>
void add_interface(const Discretisation<dim>& disc, const Share& share, Triplets& consistent,
                   Triplets& penalty) {
  const double mu = disc.problem.fluid.viscosity;
  const auto& weights = disc.problem.stabilisation;
  const Measure measure = measure_of(disc.problem.space);
  std::vector<InterfaceBasis<dim>> basis;
  for (const auto& piece : disc.cut.interface) {
    const auto& fluid_nodes = disc.fluid_nodes.part_dofs[piece.part];
    if (!share.has(disc.velocity_unknown(fluid_nodes[0], 0))) continue;
    const int cell = disc.cut.parts[piece.part].cell;
    const auto& solid_nodes = disc.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    const auto& solid_mesh = disc.placed_solids[piece.solid];
    const auto g = barycentric_gradients(disc.cut.mesh, cell);
    const Point<dim>& n = piece.normal;
    const double h = cell_diameter(disc.cut.mesh, cell);
    const double viscous_penalty = weights.nitsche_viscous * mu / h;
    const double normal_penalty = weights.nitsche_normal * phi_weight(weights, disc.problem.fluid, h) / h;

    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = disc.cut.interface_quadrature.points[q];
      const double w = disc.cut.interface_quadrature.weights[q] * measure(x[0]);
      const auto lambda = barycentric_coordinates(disc.cut.mesh, cell, x);
      const auto shape = quadratic_values<dim>(barycentric_coordinates(solid_mesh, piece.solid_cell, x));
      basis.clear();
      for (int i = 0; i <= dim; ++i) {
        for (int c = 0; c < dim; ++c) {
          Point<dim> traction = mu * n[c] * g.col(i);
          traction[c] += mu * g.col(i).dot(n);
          basis.push_back({disc.velocity_unknown(fluid_nodes[i], c), c, lambda[i], traction, 0.0});
        }
        basis.push_back({disc.pressure_unknown(fluid_nodes[i]), -1, 0.0, Point<dim>::Zero(), lambda[i]});
      }
      for (std::size_t k = 0; k < solid_nodes.size(); ++k)
        for (int c = 0; c < dim; ++c)
          basis.push_back(
              {disc.solid_unknown(piece.solid, solid_nodes[k], c), c, -shape[k], Point<dim>::Zero(), 0.0});

      for (const auto& test : basis)
        for (const auto& trial : basis) {
          double coupling = 0;
          if (test.component >= 0) // -(sigma(trial) n) . jump(test)
            coupling -= (trial.traction[test.component] - trial.pressure * n[test.component]) * test.jump;
          if (trial.component >= 0) // -(2 mu eps(test) n + q n) . jump(trial)
            coupling -= (test.traction[trial.component] + test.pressure * n[trial.component]) * trial.jump;
          if (coupling != 0) consistent.emplace_back(test.unknown, trial.unknown, w * coupling);
          if (test.component < 0 || trial.component < 0) continue;
          const double jumps = w * test.jump * trial.jump;
          const double tangential = test.component == trial.component ? viscous_penalty : 0.0;
          penalty.emplace_back(
              test.unknown, trial.unknown,
              jumps * (tangential + normal_penalty * n[test.component] * n[trial.component]));
        }
    }
  }
}

template void add_interface(const Discretisation<2>&, const Share&, Triplets&, Triplets&);

} // namespace undula
