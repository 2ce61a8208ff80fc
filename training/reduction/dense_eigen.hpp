// The small dense eigenvalue and singular value problems of the POD, by SLEPc, on every rank by itself.
#pragma once

#include <Eigen/Core>

namespace undula::training {

struct DenseEigen {
  Eigen::VectorXd values;  ///< falling
  Eigen::MatrixXd vectors; ///< orthonormal columns
};

/// All eigenpairs of the symmetric matrix (SLEPc EPS, LAPACK). Throws NumericsError.
DenseEigen symmetric_eigenpairs(Eigen::MatrixXd matrix);

struct LeftSingular {
  Eigen::VectorXd values;  ///< falling, min(rows, columns) of them
  Eigen::MatrixXd vectors; ///< orthonormal columns, rows x min(rows, columns)
};

/// Singular values and left singular vectors (SLEPc SVD, LAPACK). Throws NumericsError.
LeftSingular left_singular_vectors(Eigen::MatrixXd matrix);

} // namespace undula::training
