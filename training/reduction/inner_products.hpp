// Matrices that measure fields, and parts of matrices.
#pragma once

#include <Eigen/SparseCore>
#include <span>

#include "fom/levels/prepared_scene.hpp"
#include "training/training.hpp"

namespace undula::training {

using ColumnSparse = Eigen::SparseMatrix<double>;

/// Rows and columns `unknowns` of a matrix.
ColumnSparse submatrix(const SparseMatrix& matrix, std::span<const int> unknowns);

/// The pressure's L2 product, on all unknowns.
SparseMatrix pressure_product(const PreparedScene& prepared);

} // namespace undula::training
