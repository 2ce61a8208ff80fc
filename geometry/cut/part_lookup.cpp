#include "geometry/cut/part_lookup.hpp"

#include <Eigen/LU>

namespace undula::geometry {

template <int dim>
bool simplex_contains(const std::array<Point<dim>, dim + 1>& vertices, const Point<dim>& x) {
  // lambda_i = det(edges with column i replaced) / det(edges), signs compared without dividing: a simplex of
  // rounding size must not become a division by zero.
  Eigen::Matrix<double, dim, dim> edges;
  for (int i = 0; i < dim; ++i) edges.col(i) = vertices[i + 1] - vertices[0];
  const double whole = edges.determinant();
  const Point<dim> from_first = x - vertices[0];
  double rest = std::abs(whole);
  for (int i = 0; i < dim; ++i) {
    auto replaced = edges;
    replaced.col(i) = from_first;
    const double share = whole > 0 ? replaced.determinant() : -replaced.determinant();
    if (!(share >= 0)) return false;
    rest -= share;
  }
  return rest >= 0;
}

template <int dim>
bool part_contains(const CutMesh<dim>& cut, int part, const Point<dim>& x) {
  const auto& record = cut.parts[part];
  if (!record.cut) return true;
  for (int s = record.simplex_begin; s < record.simplex_end; ++s)
    if (simplex_contains<dim>(cut.simplices[s], x)) return true;
  return false;
}

template <int dim>
int part_at(const CutMesh<dim>& cut, int cell, const Point<dim>& x) {
  for (int part = cut.cell_parts[cell]; part < cut.cell_parts[cell + 1]; ++part)
    if (part_contains(cut, part, x)) return part;
  return -1;
}

#define UNDULA_INSTANTIATE(dim)                                                                   \
  template bool simplex_contains<dim>(const std::array<Point<dim>, dim + 1>&, const Point<dim>&); \
  template bool part_contains<dim>(const CutMesh<dim>&, int, const Point<dim>&);                  \
  template int part_at<dim>(const CutMesh<dim>&, int, const Point<dim>&);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
