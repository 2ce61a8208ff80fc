#include "rom/fixed_domain/panel_product.hpp"

#include <algorithm>
#include <cstring>

namespace undula::rom {
namespace {

constexpr Eigen::Index panel_rows = 8; // one vector of AVX-512, two of AVX2, four of SSE2
constexpr Eigen::Index block_columns = 6;

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define UNDULA_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define UNDULA_VECTOR_CLONES
#endif

using Rows = double __attribute__((vector_size(panel_rows * sizeof(double))));

// out (panel_rows x block_columns) = panel (panel_rows x inner) * b (inner x block_columns, row after row).
UNDULA_VECTOR_CLONES
void multiply_panels(const double* panels, Eigen::Index panel_count, const double* b,
                     Eigen::Index block_count, Eigen::Index inner, double* out, Eigen::Index out_stride) {
  for (Eigen::Index p = 0; p < panel_count; ++p) {
    for (Eigen::Index block = 0; block < block_count; ++block) {
      const double* a = panels + p * inner * panel_rows;
      const double* right = b + block * inner * block_columns;
      Rows sum[block_columns] = {};
      for (Eigen::Index k = 0; k < inner; ++k, a += panel_rows, right += block_columns) {
        Rows column;
        std::memcpy(&column, a, sizeof column);
#pragma GCC unroll 6
        for (Eigen::Index c = 0; c < block_columns; ++c) sum[c] += column * right[c];
      }
      for (Eigen::Index c = 0; c < block_columns; ++c)
        std::memcpy(out + (block * block_columns + c) * out_stride + p * panel_rows, &sum[c], sizeof sum[c]);
    }
  }
}

} // namespace

PanelProduct::PanelProduct(const Eigen::MatrixXd& matrix) : rows_(matrix.rows()), inner_(matrix.cols()) {
  const auto panel_count = (rows_ + panel_rows - 1) / panel_rows;
  panels_.assign(static_cast<std::size_t>(panel_count * panel_rows * inner_), 0.0);
  double* to = panels_.data();
  for (Eigen::Index p = 0; p < panel_count; ++p) {
    const auto kept = std::min(panel_rows, rows_ - p * panel_rows);
    for (Eigen::Index k = 0; k < inner_; ++k, to += panel_rows)
      std::copy_n(matrix.col(k).data() + p * panel_rows, kept, to);
  }
}

void PanelProduct::multiply(const Eigen::MatrixXd& b, Eigen::MatrixXd& out) const {
  const auto panel_count = (rows_ + panel_rows - 1) / panel_rows;
  const auto block_count = (b.cols() + block_columns - 1) / block_columns;
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(block_columns * inner_, block_count);
  for (Eigen::Index c = 0; c < b.cols(); ++c)
    for (Eigen::Index k = 0; k < inner_; ++k)
      blocks(k * block_columns + c % block_columns, c / block_columns) = b(k, c);
  // Padded to whole panels and blocks, of which only the true part is handed out.
  out.resize(panel_count * panel_rows, block_count * block_columns);
  multiply_panels(panels_.data(), panel_count, blocks.data(), block_count, inner_, out.data(), out.rows());
}

} // namespace undula::rom
