// Quadratic (P2) Lagrange space on a solid's mesh: vertices first, then edge mid-points.
#pragma once

#include <array>
#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

template <int dim>
struct QuadraticSpace {
  static constexpr int nodes_per_cell = (dim + 1) * (dim + 2) / 2;
  std::vector<Point<dim>> nodes; ///< cm
  std::vector<std::array<int, nodes_per_cell>>
      cell_nodes; ///< dim+1 vertices, then edges (0,1),(0,2),..,(1,2),..
};

template <int dim>
QuadraticSpace<dim> build_quadratic_space(const SimplexMesh<dim>& mesh);

template <int dim>
using QuadraticValues = Eigen::Matrix<double, QuadraticSpace<dim>::nodes_per_cell, 1>;
template <int dim>
using QuadraticGradients = Eigen::Matrix<double, dim, QuadraticSpace<dim>::nodes_per_cell>;

/// Shape functions at barycentric coordinates `lambda`.
template <int dim>
QuadraticValues<dim> quadratic_values(const Eigen::Matrix<double, dim + 1, 1>& lambda);

/// Their gradients, 1/cm, from the gradients of the barycentric coordinates; column per node.
template <int dim>
QuadraticGradients<dim> quadratic_gradients(const Eigen::Matrix<double, dim + 1, 1>& lambda,
                                            const Eigen::Matrix<double, dim, dim + 1>& barycentric_gradients);

} // namespace undula::fom
