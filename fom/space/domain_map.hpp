// Motion of the fluid's domain: the ALE map from the domain at rest, x = X + displacement(X).
#pragma once

#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// Nodal (P1) values on the fluid nodes of a cut. Empty: the identity.
template <int dim>
struct DomainMap {
  std::vector<Point<dim>> displacement; ///< by fluid node, cm
  std::vector<Point<dim>> velocity;     ///< its rate, cm/s
  bool is_identity() const { return displacement.empty(); }
};

/// Nodal vectors in a row, component after component, as a state keeps them.
template <int dim>
Eigen::VectorXd in_a_row(const std::vector<Point<dim>>& values) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(values.size()) * dim);
  for (std::size_t node = 0; node < values.size(); ++node)
    row.segment<dim>(static_cast<Eigen::Index>(node) * dim) = values[node];
  return row;
}

/// The other way.
template <int dim>
std::vector<Point<dim>> by_node(const Eigen::VectorXd& row) {
  std::vector<Point<dim>> values;
  values.reserve(static_cast<std::size_t>(row.size() / dim));
  for (Eigen::Index at = 0; at < row.size(); at += dim) values.push_back(row.segment<dim>(at));
  return values;
}

} // namespace undula::fom
