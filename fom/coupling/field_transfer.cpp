#include "fom/coupling/field_transfer.hpp"

#include "fom/assembly/facet_patch.hpp"
#include "fom/fom.hpp"
#include "geometry/cut/dof_matching.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// Weight of the skin's velocity against the ghost penalty. It decides only where the ghost penalty leaves
/// the extension open.
constexpr double skin_weight = 1e-4;

} // namespace

template <int dim>
FieldTransfer<dim>::FieldTransfer(const Discretisation<dim>& before, const Discretisation<dim>& now)
    : fluid_before_(before.fluid_unknowns()),
      fluid_now_(now.fluid_unknowns()),
      solids_(now.solid_unknowns()),
      source_(match_dofs(before.cut, before.fluid_nodes, now.cut, now.fluid_nodes)) {
  const int nodes = static_cast<int>(source_.size());
  std::vector<int> row_of(source_.size(), -1);
  for (int node = 0; node < nodes; ++node)
    if (source_[node] < 0) {
      row_of[node] = extended();
      new_nodes_.push_back(node);
    }
  if (new_nodes_.empty()) return;

  const int rows = extended();
  std::vector<Eigen::Triplet<double>> matrix, coupling;
  const auto add = [&](int row_node, int column_node, double value) {
    const int row = row_of[row_node];
    if (row < 0) return;
    if (const int column = row_of[column_node]; column >= 0)
      matrix.emplace_back(row, column, value);
    else
      coupling.emplace_back(row, column_node, -value);
  };
  const auto touches_new = [&](int part) {
    for (const int node : now.fluid_nodes.part_dofs[part])
      if (row_of[node] >= 0) return true;
    return false;
  };
  for (const auto& connection : now.cut.connections) {
    if (!touches_new(connection.part[0]) && !touches_new(connection.part[1])) continue;
    const auto patch = facet_patch(now, connection, part_geometry(now, connection.part[0]),
                                   part_geometry(now, connection.part[1]));
    for (int i = 0; i < dim + 2; ++i)
      for (int j = 0; j < dim + 2; ++j)
        add(patch.nodes[i], patch.nodes[j],
            patch.area * patch.size * patch.normal_jump[i] * patch.normal_jump[j]);
  }
  for (const auto& piece : now.cut.interface) {
    if (!touches_new(piece.part)) continue;
    const auto& nodes_of_part = now.fluid_nodes.part_dofs[piece.part];
    const auto& skin_nodes = now.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    const int cell = now.cut.parts[piece.part].cell;
    const double weight = skin_weight / cell_diameter(now.cut.mesh, cell);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = now.cut.interface_quadrature.points[q];
      const double w = weight * now.cut.interface_quadrature.weights[q];
      const auto lambda = barycentric_coordinates(now.cut.mesh, cell, x);
      const auto shape =
          quadratic_values<dim>(barycentric_coordinates(now.placed_solids[piece.solid], piece.solid_cell, x));
      for (int i = 0; i <= dim; ++i) {
        const int row = row_of[nodes_of_part[i]];
        if (row < 0) continue;
        for (int j = 0; j <= dim; ++j) add(nodes_of_part[i], nodes_of_part[j], w * lambda[i] * lambda[j]);
        for (std::size_t k = 0; k < skin_nodes.size(); ++k)
          coupling.emplace_back(row,
                                nodes + (now.solid_unknown(piece.solid, skin_nodes[k], 0) - fluid_now_) / dim,
                                w * lambda[i] * shape[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  // A pocket that neither touches the skin nor the old fluid cannot be: its cut cell has a skin. What
  // rounding leaves of slivers is held at rest.
  double largest = 0;
  for (const auto& entry : matrix) largest = std::max(largest, entry.value());
  for (int row = 0; row < rows; ++row) matrix.emplace_back(row, row, 1e-12 * largest);
  Eigen::SparseMatrix<double> penalty(rows, rows);
  penalty.setFromTriplets(matrix.begin(), matrix.end());
  coupling_.resize(rows, nodes + solids_ / dim);
  coupling_.setFromTriplets(coupling.begin(), coupling.end());
  extension_.compute(penalty);
  if (extension_.info() != Eigen::Success)
    throw NumericsError("new fluid could not take its history from its neighbours",
                        std::to_string(rows) + " new nodes", "a smaller time step");
}

template <int dim>
Eigen::VectorXd FieldTransfer<dim>::unknowns(const Eigen::VectorXd& before) const {
  Eigen::VectorXd now = Eigen::VectorXd::Zero(fluid_now_ + solids_);
  now.tail(solids_) = before.tail(solids_);
  for (std::size_t node = 0; node < source_.size(); ++node)
    if (source_[node] >= 0)
      now.template segment<dim + 1>(static_cast<Eigen::Index>(node) * (dim + 1)) =
          before.template segment<dim + 1>(source_[node] * (dim + 1));
  if (new_nodes_.empty()) return now;
  const auto nodes = static_cast<Eigen::Index>(source_.size());
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(coupling_.cols(), dim + 1);
  for (Eigen::Index node = 0; node < nodes; ++node)
    known.row(node) = now.template segment<dim + 1>(node * (dim + 1)).transpose();
  for (Eigen::Index node = 0; node < solids_ / dim; ++node)
    known.row(nodes + node).template head<dim>() =
        before.template segment<dim>(fluid_before_ + node * dim).transpose();
  const Eigen::MatrixXd extended_values = extension_.solve(coupling_ * known);
  for (std::size_t k = 0; k < new_nodes_.size(); ++k)
    now.template segment<dim + 1>(new_nodes_[k] * (dim + 1)) =
        extended_values.row(static_cast<Eigen::Index>(k)).transpose();
  return now;
}

template <int dim>
Eigen::VectorXd FieldTransfer<dim>::displacements(const Eigen::VectorXd& before) const {
  Eigen::VectorXd now = Eigen::VectorXd::Zero(fluid_now_ + solids_);
  now.tail(solids_) = before.tail(solids_);
  return now;
}

template class FieldTransfer<2>;

template class FieldTransfer<3>;

} // namespace undula::fom
