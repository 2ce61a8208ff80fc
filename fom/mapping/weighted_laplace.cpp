#include "fom/mapping/weighted_laplace.hpp"

#include <algorithm>

#include "fom/assembly/facet_patch.hpp"
#include "fom/mapping/map_penalties.hpp"

namespace undula::fom {

template <int dim>
WeightedLaplace<dim> weighted_laplace(const Discretisation<dim>& disc,
                                      std::span<const PartGeometry<dim>> geometries,
                                      std::span<const double> weights, const Point<dim>& axes) {
  const auto& cut = disc.cut;
  const int size = static_cast<int>(disc.fluid_nodes.dof_point.size());
  Triplets matrix;
  matrix.reserve(cut.parts.size() * (dim + 1) * (dim + 1) + cut.interface.size() * (dim + 1) * (dim + 1) * 2);
  WeightedLaplace<dim> problem;
  problem.rhs = Eigen::VectorXd::Zero(size);

  std::vector<double> stiffest(size, 0.0);
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& nodes = disc.fluid_nodes.part_dofs[p];
    const auto& g = geometries[p].reference_gradients;
    const auto local = (weights[p] * cut.parts[p].measure * g.transpose() * axes.asDiagonal() * g).eval();
    for (int i = 0; i <= dim; ++i) {
      stiffest[nodes[i]] = std::max(stiffest[nodes[i]], weights[p]);
      for (int j = 0; j <= dim; ++j) matrix.emplace_back(nodes[i], nodes[j], local(i, j));
    }
  }

  for (const auto& connection : cut.connections) {
    const int first = connection.part[0], second = connection.part[1];
    if (!cut.parts[first].cut && !cut.parts[second].cut) continue;
    const auto patch = facet_patch(disc, connection, geometries[first], geometries[second]);
    const double conductance = 0.5 * (weights[first] + weights[second]) * patch.normal.cwiseAbs2().dot(axes);
    const double weight = map_ghost_penalty * conductance * patch.size * patch.area;
    for (int i = 0; i < dim + 2; ++i)
      for (int j = 0; j < dim + 2; ++j)
        matrix.emplace_back(patch.nodes[i], patch.nodes[j],
                            weight * patch.normal_jump[i] * patch.normal_jump[j]);
  }

  for (const auto& piece : cut.interface) {
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    const auto& geometry = geometries[piece.part];
    const Point<dim> conormal = axes.cwiseProduct(piece.normal);
    // The penalty has to hold the skin against the stiffest element around, else a soft one lets go of it.
    double around = 0;
    for (const int node : nodes) around = std::max(around, stiffest[node]);
    const double penalty = map_skin_penalty * around * conormal.dot(piece.normal) /
                           cell_diameter(cut.mesh, cut.parts[piece.part].cell);
    const Eigen::Matrix<double, dim + 1, 1> flux =
        weights[piece.part] * (geometry.reference_gradients.transpose() * conormal);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const double w = cut.interface_quadrature.weights[q];
      const auto lambda = geometry.barycentric(cut.interface_quadrature.points[q]);
      for (int i = 0; i <= dim; ++i) {
        for (int j = 0; j <= dim; ++j)
          matrix.emplace_back(
              nodes[i], nodes[j],
              w * (penalty * lambda[i] * lambda[j] - flux[j] * lambda[i] - flux[i] * lambda[j]));
        problem.rhs[nodes[i]] += w * (penalty * lambda[i] - flux[i]);
      }
    }
  }
  problem.matrix = compress(size, matrix);
  return problem;
}

template WeightedLaplace<2> weighted_laplace(const Discretisation<2>&, std::span<const PartGeometry<2>>,
                                             std::span<const double>, const Point<2>&);

template WeightedLaplace<3> weighted_laplace(const Discretisation<3>&, std::span<const PartGeometry<3>>,
                                             std::span<const double>, const Point<3>&);

} // namespace undula::fom
