#include "fom/space/solid_space.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace undula::fom {

template <int dim>
QuadraticSpace<dim> build_quadratic_space(const SimplexMesh<dim>& mesh) {
  QuadraticSpace<dim> space;
  space.nodes = mesh.points;
  std::map<std::pair<int, int>, int> edge_node;
  for (const auto& cell : mesh.cells) {
    std::array<int, QuadraticSpace<dim>::nodes_per_cell> nodes;
    std::copy(cell.begin(), cell.end(), nodes.begin());
    int local = dim + 1;
    for (int a = 0; a <= dim; ++a)
      for (int b = a + 1; b <= dim; ++b) {
        const std::pair<int, int> edge = std::minmax(cell[a], cell[b]);
        const auto [entry, is_new] = edge_node.try_emplace(edge, static_cast<int>(space.nodes.size()));
        if (is_new) space.nodes.push_back(0.5 * (mesh.points[edge.first] + mesh.points[edge.second]));
        nodes[local++] = entry->second;
      }
    space.cell_nodes.push_back(nodes);
  }
  return space;
}

template <int dim>
QuadraticValues<dim> quadratic_values(const Eigen::Matrix<double, dim + 1, 1>& lambda) {
  QuadraticValues<dim> values;
  for (int a = 0; a <= dim; ++a) values[a] = lambda[a] * (2 * lambda[a] - 1);
  int local = dim + 1;
  for (int a = 0; a <= dim; ++a)
    for (int b = a + 1; b <= dim; ++b) values[local++] = 4 * lambda[a] * lambda[b];
  return values;
}

template <int dim>
QuadraticGradients<dim> quadratic_gradients(
    const Eigen::Matrix<double, dim + 1, 1>& lambda,
    const Eigen::Matrix<double, dim, dim + 1>& barycentric_gradients) {
  QuadraticGradients<dim> gradients;
  for (int a = 0; a <= dim; ++a) gradients.col(a) = (4 * lambda[a] - 1) * barycentric_gradients.col(a);
  int local = dim + 1;
  for (int a = 0; a <= dim; ++a)
    for (int b = a + 1; b <= dim; ++b)
      gradients.col(local++) =
          4 * (lambda[a] * barycentric_gradients.col(b) + lambda[b] * barycentric_gradients.col(a));
  return gradients;
}

template QuadraticSpace<2> build_quadratic_space<2>(const SimplexMesh<2>&);
template QuadraticValues<2> quadratic_values<2>(const Eigen::Vector3d&);
template QuadraticGradients<2> quadratic_gradients<2>(const Eigen::Vector3d&,
                                                      const Eigen::Matrix<double, 2, 3>&);

template QuadraticSpace<3> build_quadratic_space<3>(const SimplexMesh<3>&);
template QuadraticValues<3> quadratic_values<3>(const Eigen::Vector4d&);
template QuadraticGradients<3> quadratic_gradients<3>(const Eigen::Vector4d&,
                                                      const Eigen::Matrix<double, 3, 4>&);

} // namespace undula::fom
