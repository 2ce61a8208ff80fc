#include "training/reduction/inner_products.hpp"

#include <vector>

namespace undula::training {

ColumnSparse submatrix(const SparseMatrix& matrix, std::span<const int> unknowns) {
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    place[static_cast<std::size_t>(unknowns[i])] = static_cast<int>(i);
  Triplets entries;
  for (const int row : unknowns)
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
      if (const int column = place[static_cast<std::size_t>(entry.col())]; column >= 0)
        entries.emplace_back(place[static_cast<std::size_t>(row)], column, entry.value());
  ColumnSparse result(static_cast<Eigen::Index>(unknowns.size()), static_cast<Eigen::Index>(unknowns.size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

SparseMatrix pressure_product(const PreparedScene& prepared) {
  const auto& disc = prepared.disc;
  // It has the pattern of the parts' moments.
  Triplets entries;
  for (const int part : prepared.operators.own_parts) {
    const auto moments = integrate_part(disc, part, prepared.operators.geometries[part]).moments;
    const auto& nodes = disc.fluid_nodes.part_dofs[part];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        entries.emplace_back(disc.pressure_unknown(nodes[i]), disc.pressure_unknown(nodes[j]), moments(i, j));
  }
  return compress(disc.unknowns(), entries);
}

} // namespace undula::training
