#include "fom/mapping/skin_elasticity.hpp"

#include "fom/assembly/facet_patch.hpp"
#include "fom/mapping/map_penalties.hpp"

namespace undula::fom {

namespace {

/// 2 eps(lambda_j e_d) n for all j, d: column j * dim + d.
template <int dim>
Eigen::Matrix<double, dim, dim*(dim + 1)> tractions(const PartGeometry<dim>& geometry,
                                                    const Point<dim>& normal) {
  Eigen::Matrix<double, dim, dim*(dim + 1)> columns;
  for (int j = 0; j <= dim; ++j) {
    const Point<dim> g = geometry.reference_gradients.col(j);
    for (int d = 0; d < dim; ++d) {
      columns.col(j * dim + d) = g * normal[d];
      columns(d, j * dim + d) += g.dot(normal);
    }
  }
  return columns;
}

/// (2 eps(y), eps(z)), the ghost penalty and the penalty on bends.
template <int dim>
void add_medium(const Discretisation<dim>& disc, std::span<const PartGeometry<dim>> geometries,
                double smoothing_length, Triplets& matrix) {
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    const auto& nodes = disc.fluid_nodes.part_dofs[p];
    const auto& g = geometries[p].reference_gradients;
    const double w = disc.cut.parts[p].measure;
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j) {
        const double laplace = g.col(i).dot(g.col(j));
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            matrix.emplace_back(nodes[i] * dim + c, nodes[j] * dim + d,
                                w * ((c == d ? laplace : 0.0) + g(d, i) * g(c, j)));
      }
  }
  for (const auto& connection : disc.cut.connections) {
    const auto patch =
        facet_patch(disc, connection, geometries[connection.part[0]], geometries[connection.part[1]]);
    const double weight = 2 * patch.area *
                          ((patch.cut ? map_ghost_penalty * patch.size : 0.0) +
                           smoothing_length * smoothing_length / patch.size);
    for (int i = 0; i < dim + 2; ++i)
      for (int j = 0; j < dim + 2; ++j)
        for (int c = 0; c < dim; ++c)
          matrix.emplace_back(patch.nodes[i] * dim + c, patch.nodes[j] * dim + c,
                              weight * patch.normal_jump[i] * patch.normal_jump[j]);
  }
}

template <int dim>
void add_skin(const Discretisation<dim>& disc, std::span<const PartGeometry<dim>> geometries,
              double skin_penalty, Triplets& matrix, Triplets& data) {
  const auto& cut = disc.cut;
  for (const auto& piece : cut.interface) {
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    const auto& solid_nodes = disc.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    const auto& geometry = geometries[piece.part];
    const double penalty = 2 * skin_penalty / cell_diameter(cut.mesh, cut.parts[piece.part].cell);
    const auto flux = tractions<dim>(geometry, piece.normal);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& place = cut.interface_quadrature.points[q];
      const double w = cut.interface_quadrature.weights[q];
      const auto lambda = geometry.barycentric(place);
      const auto shape = quadratic_values<dim>(
          barycentric_coordinates(disc.placed_solids[piece.solid], piece.solid_cell, place));
      for (int i = 0; i <= dim; ++i)
        for (int c = 0; c < dim; ++c) {
          const int row = nodes[i] * dim + c;
          for (int d = 0; d < dim; ++d) {
            const double held = c == d ? penalty * lambda[i] : 0.0, pull = flux(d, i * dim + c);
            for (int j = 0; j <= dim; ++j)
              matrix.emplace_back(row, nodes[j] * dim + d,
                                  w * ((held - pull) * lambda[j] - flux(c, j * dim + d) * lambda[i]));
            for (std::size_t k = 0; k < solid_nodes.size(); ++k)
              data.emplace_back(row,
                                disc.solid_unknown(piece.solid, solid_nodes[k], d) - disc.fluid_unknowns(),
                                w * (held - pull) * shape[k]);
          }
        }
    }
  }
}

} // namespace

template <int dim>
SkinElasticity<dim> skin_elasticity(const Discretisation<dim>& disc,
                                    std::span<const PartGeometry<dim>> geometries, double smoothing_length,
                                    double skin_penalty) {
  Triplets matrix, data;
  constexpr std::size_t per_part = (dim + 1) * (dim + 1) * dim * dim;
  matrix.reserve((disc.cut.parts.size() + 2 * disc.cut.interface.size()) * per_part);
  add_medium<dim>(disc, geometries, smoothing_length, matrix);
  add_skin<dim>(disc, geometries, skin_penalty, matrix, data);
  SkinElasticity<dim> problem;
  const int size = static_cast<int>(disc.fluid_nodes.dof_point.size()) * dim;
  problem.matrix = compress(size, matrix);
  problem.data.resize(size, disc.solid_unknowns());
  problem.data.setFromTriplets(data.begin(), data.end());
  return problem;
}

template SkinElasticity<2> skin_elasticity(const Discretisation<2>&, std::span<const PartGeometry<2>>, double,
                                           double);

template SkinElasticity<3> skin_elasticity(const Discretisation<3>&, std::span<const PartGeometry<3>>, double,
                                           double);

} // namespace undula::fom
