#include "fom/assembly/forms.hpp"
#include "fom/space/velocity_element.hpp"

namespace undula::fom {

namespace {

template <int dim, int order>
void add_interface_of(const Discretisation<dim>& disc, const Share& share,
                      std::span<const PartGeometry<dim>> geometries, Triplets& consistent,
                      Triplets& penalty) {
  using Element = VelocityElement<dim, order>;
  const double mu = disc.problem.fluid.viscosity;
  const auto& weights = disc.problem.stabilisation;
  const Measure measure = measure_of(disc.problem.space);
  const bool moved = !disc.map.is_identity();
  // Basis functions seen by a piece: the fluid's velocities, its pressures, then the solid's velocities.
  constexpr int pressures = dim * Element::nodes, fluid_size = pressures + dim + 1;
  constexpr int size = fluid_size + dim * QuadraticSpace<dim>::nodes_per_cell;
  using Local = Eigen::Matrix<double, size, size>;
  using PerComponent = Eigen::Matrix<double, size, dim>;
  std::array<int, size> unknowns;
  for (const auto& piece : disc.cut.interface) {
    const auto fluid_nodes = Element::nodes_of(disc, piece.part);
    if (!share.has(disc.velocity_unknown(fluid_nodes[0], 0))) continue;
    const auto& geometry = geometries[piece.part];
    if (geometry.weight == 0) continue;
    const auto& solid_nodes = disc.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    const auto& solid_mesh = disc.placed_solids[piece.solid];
    // Nanson: the moved area vector is cof F N dA. The solid's shape functions live at the place at rest.
    const Point<dim> area_vector = geometry.cofactor * piece.normal;
    const double area_ratio = moved ? area_vector.norm() : 1.0;
    const Point<dim> n = area_vector / area_ratio;
    const double thinning = geometry.volume_ratio / area_ratio; // of the element, along n
    const double h = cell_diameter(disc.cut.mesh, disc.cut.parts[piece.part].cell) * thinning;
    const double viscous_penalty = weights.nitsche_viscous * mu / h;
    const double normal_penalty = weights.nitsche_normal * phi_weight(weights, disc.problem.fluid, h) / h;
    // The penalty acts as one more slip length, in series with the wall's own: `held` is the part of the
    // tangential jump that Nitsche's terms hold, exactly 1 without slip and 0 on a skin without friction.
    const double penalty_length = h / weights.nitsche_viscous;
    const double held = penalty_length / (penalty_length + disc.problem.slip_length);
    const double released = disc.problem.slip_length / (penalty_length + disc.problem.slip_length);

    // By basis function: its viscous traction 2 mu eps n, and the pressure and jump u - v_s it carries.
    PerComponent traction = PerComponent::Zero(), jump = PerComponent::Zero();
    PerComponent held_jump; // normal component and held part of the tangential one
    Eigen::Matrix<double, size, 1> pressure = Eigen::Matrix<double, size, 1>::Zero();
    for (int i = 0; i < Element::nodes; ++i)
      for (int c = 0; c < dim; ++c) unknowns[i * dim + c] = disc.velocity_unknown(fluid_nodes[i], c);
    for (int a = 0; a <= dim; ++a) unknowns[pressures + a] = disc.pressure_unknown(fluid_nodes[a]);
    for (std::size_t k = 0; k < solid_nodes.size(); ++k)
      for (int c = 0; c < dim; ++c)
        unknowns[fluid_size + k * dim + c] = disc.solid_unknown(piece.solid, solid_nodes[k], c);

    Local coupling = Local::Zero(), penalties = Local::Zero();
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& place = disc.cut.interface_quadrature.points[q];
      const auto lambda = geometry.barycentric(place);
      const double radius = moved ? geometry.corners.row(0).dot(lambda) : place[0];
      const double w =
          geometry.weight * disc.cut.interface_quadrature.weights[q] * area_ratio * measure(radius);
      const auto shape = quadratic_values<dim>(barycentric_coordinates(solid_mesh, piece.solid_cell, place));
      const auto value = Element::values(lambda);
      const auto g = Element::gradients(lambda, geometry.gradients);
      for (int i = 0; i < Element::nodes; ++i)
        for (int c = 0; c < dim; ++c) {
          const int at = i * dim + c;
          jump(at, c) = value[i];
          traction.row(at) = mu * n[c] * g.col(i).transpose();
          traction(at, c) += mu * g.col(i).dot(n);
        }
      pressure.template segment<dim + 1>(pressures) = lambda;
      for (std::size_t k = 0; k < solid_nodes.size(); ++k)
        for (int c = 0; c < dim; ++c) jump(fluid_size + k * dim + c, c) = -shape[k];
      const Eigen::Matrix<double, size, 1> normal_jump = jump * n;
      held_jump = held * jump + released * normal_jump * n.transpose();
      // -(sigma(trial) n) . jump(test) - (2 mu eps(test) n + q n) . jump(trial)
      coupling.noalias() -= (w * held_jump) * (traction - pressure * n.transpose()).transpose();
      coupling.noalias() -= (w * (traction + pressure * n.transpose())) * held_jump.transpose();
      penalties.noalias() += (w * viscous_penalty * held_jump) * jump.transpose();
      penalties.noalias() += (w * normal_penalty * normal_jump) * normal_jump.transpose();
      if (released > 0) {
        const PerComponent friction = traction - (traction * n) * n.transpose();
        coupling.noalias() -= (w * released / viscous_penalty * friction) * friction.transpose();
      }
    }
    const auto has_jump = [](int at) { return at >= fluid_size || at < pressures; };
    for (int a = 0; a < size; ++a)
      for (int b = 0; b < size; ++b) {
        if (a < fluid_size || b < fluid_size)
          consistent.emplace_back(unknowns[a], unknowns[b], coupling(a, b));
        if (has_jump(a) && has_jump(b)) penalty.emplace_back(unknowns[a], unknowns[b], penalties(a, b));
      }
  }
}

} // namespace

template <int dim>
void add_interface(const Discretisation<dim>& disc, const Share& share,
                   std::span<const PartGeometry<dim>> geometries, Triplets& consistent, Triplets& penalty) {
  with_order(disc,
             [&](auto order) { add_interface_of<dim, order>(disc, share, geometries, consistent, penalty); });
}

template void add_interface(const Discretisation<2>&, const Share&, std::span<const PartGeometry<2>>,
                            Triplets&, Triplets&);

template void add_interface(const Discretisation<3>&, const Share&, std::span<const PartGeometry<3>>,
                            Triplets&, Triplets&);

} // namespace undula::fom
