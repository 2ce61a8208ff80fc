// Product of a fixed tall matrix with many small right-hand sides, at the speed of the machine it runs on.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace undula::rom {

/// A (rows x inner), packed once; product(b) = A b. Vector instructions are chosen at run time, but every
/// entry is summed in the same order without fused operations, so that results are the same bit for bit on
/// every x86-64.
class PanelProduct {
public:
  PanelProduct() = default;
  explicit PanelProduct(const Eigen::MatrixXd& matrix);

  Eigen::Index rows() const { return rows_; }

  /// Top left corner (rows x b.cols()) of out = A b; out is larger, by padding. b has `inner` rows.
  void multiply(const Eigen::MatrixXd& b, Eigen::MatrixXd& out) const;

private:
  Eigen::Index rows_ = 0, inner_ = 0;
  std::vector<double> panels_; ///< 8 rows each (padded with zeros), column after column
};

} // namespace undula::rom
