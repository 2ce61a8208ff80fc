#include "fom/mapping/weighted_laplace.hpp"

#include <algorithm>

namespace undula {

namespace {
// Well above the trace constants of linear elements; the ghost penalty bounds those of cut ones.
constexpr double nitsche_penalty = 20, ghost_penalty = 0.1;
} // namespace

template <int dim>
WeightedLaplace<dim> weighted_laplace(const Discretisation<dim>& disc,
                                      std::span<const PartGeometry<dim>> geometries,
                                      std::span<const double> weights, const Point<dim>& axes) {
  Triplets matrix, data;
  const auto& cut = disc.cut;
  matrix.reserve(cut.parts.size() * (dim + 1) * (dim + 1) + cut.interface.size() * (dim + 1) * (dim + 1) * 2);
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& nodes = disc.fluid_nodes.part_dofs[p];
    const auto& g = geometries[p].reference_gradients;
    const auto local = (weights[p] * cut.parts[p].measure * g.transpose() * axes.asDiagonal() * g).eval();
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j) matrix.emplace_back(nodes[i], nodes[j], local(i, j));
  }

  for (const auto& connection : cut.connections) {
    const int first = connection.part[0], second = connection.part[1];
    if (!cut.parts[first].cut && !cut.parts[second].cut) continue;
    const auto& facet = cut.facets.facets[connection.facet];
    const int cell = cut.parts[first].cell;
    const auto opposite =
        geometries[first].reference_gradients.col(facet.local[facet.cells[0] == cell ? 0 : 1]);
    const Point<dim> normal = opposite.normalized();
    const double h = std::max(cell_diameter(cut.mesh, cell), cell_diameter(cut.mesh, cut.parts[second].cell));
    const double area = dim * cell_measure(cut.mesh, cell) * opposite.norm();
    const double conductance = 0.5 * (weights[first] + weights[second]) * normal.cwiseAbs2().dot(axes);
    Eigen::Matrix<double, 2 * (dim + 1), 1> jump;
    std::array<int, 2 * (dim + 1)> nodes;
    for (int a = 0; a <= dim; ++a) {
      nodes[a] = disc.fluid_nodes.part_dofs[first][a];
      nodes[dim + 1 + a] = disc.fluid_nodes.part_dofs[second][a];
      jump[a] = geometries[first].reference_gradients.col(a).dot(normal);
      jump[dim + 1 + a] = -geometries[second].reference_gradients.col(a).dot(normal);
    }
    for (int i = 0; i < 2 * (dim + 1); ++i)
      for (int j = 0; j < 2 * (dim + 1); ++j)
        matrix.emplace_back(nodes[i], nodes[j], ghost_penalty * conductance * h * area * jump[i] * jump[j]);
  }

  // The penalty has to hold the skin against the stiffest element around, else a soft one lets go of it.
  std::vector<double> stiffest(disc.fluid_nodes.dof_point.size(), 0.0);
  for (std::size_t p = 0; p < cut.parts.size(); ++p)
    for (const int node : disc.fluid_nodes.part_dofs[p])
      stiffest[node] = std::max(stiffest[node], weights[p]);
  for (const auto& piece : cut.interface) {
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    const auto& solid_nodes = disc.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    const int first_solid_node = (disc.solid_offset[piece.solid] - disc.fluid_unknowns()) / dim;
    const auto& geometry = geometries[piece.part];
    const double h = cell_diameter(cut.mesh, cut.parts[piece.part].cell);
    const Point<dim> conormal = axes.cwiseProduct(piece.normal);
    const double weight = weights[piece.part];
    double around = 0;
    for (const int node : nodes) around = std::max(around, stiffest[node]);
    const double penalty = nitsche_penalty * around * conormal.dot(piece.normal) / h;
    const Eigen::Matrix<double, dim + 1, 1> flux =
        weight * (geometry.reference_gradients.transpose() * conormal);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& place = cut.interface_quadrature.points[q];
      const double w = cut.interface_quadrature.weights[q];
      const auto lambda = geometry.barycentric(place);
      const auto shape = quadratic_values<dim>(
          barycentric_coordinates(disc.placed_solids[piece.solid], piece.solid_cell, place));
      for (int i = 0; i <= dim; ++i) {
        for (int j = 0; j <= dim; ++j)
          matrix.emplace_back(
              nodes[i], nodes[j],
              w * (penalty * lambda[i] * lambda[j] - flux[j] * lambda[i] - flux[i] * lambda[j]));
        for (std::size_t k = 0; k < solid_nodes.size(); ++k)
          data.emplace_back(nodes[i], first_solid_node + solid_nodes[k],
                            w * (penalty * lambda[i] - flux[i]) * shape[k]);
      }
    }
  }
  WeightedLaplace<dim> problem;
  const int size = static_cast<int>(disc.fluid_nodes.dof_point.size());
  problem.matrix = compress(size, matrix);
  problem.data.resize(size, disc.solid_unknowns() / dim);
  problem.data.setFromTriplets(data.begin(), data.end());
  return problem;
}

template WeightedLaplace<2> weighted_laplace(const Discretisation<2>&, std::span<const PartGeometry<2>>,
                                             std::span<const double>, const Point<2>&);

} // namespace undula
