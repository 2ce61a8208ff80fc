// Condition number of the steady system matrix after diagonal scaling, by a dense singular value
// decomposition.
#pragma once

#include <Eigen/SVD>
#include <cmath>

#include "fom/system/operators.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// Ratio of the extreme singular values of the free rows and columns of physical + stabilisation, rows and
/// columns of each unknown scaled by the square root of the same positive number `scale[unknown]`.
template <int dim>
double condition_number(const Discretisation<dim>& disc, const Operators<dim>& operators,
                        const Eigen::VectorXd& scale) {
  std::vector<int> place(disc.unknowns(), -1);
  int size = 0;
  for (int unknown = 0; unknown < disc.unknowns(); ++unknown)
    if (!disc.is_constrained[unknown]) place[unknown] = size++;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (const auto* term : {&operators.physical, &operators.stabilisation})
    for (int row = 0; row < term->outerSize(); ++row)
      for (SparseMatrix::InnerIterator entry(*term, row); entry; ++entry)
        if (place[row] >= 0 && place[entry.col()] >= 0)
          matrix(place[row], place[entry.col()]) +=
              entry.value() / std::sqrt(scale[row] * scale[entry.col()]);
  const Eigen::VectorXd values = Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values.maxCoeff() / values.minCoeff();
}

} // namespace undula::verification
