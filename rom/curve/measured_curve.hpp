// Measured head-flow points: reading, fitting, extracting.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace undula::rom {

/// Q(H) = c0 + c1 H + c2 H^2, H in mmHg, Q in l/min.
struct QuadraticFit {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  /// sqrt(sum of squared residuals / (n - 3)): the standard deviation of a sample; 0 for n = 3
  double scatter_l_per_min = 0;

  [[nodiscard]] double operator()(double head_mmHg) const;
};

/// Samples sorted by head (by flow where heads agree), and their least-squares fit.
struct MeasuredCurve {
  std::vector<double> head_mmHg;
  std::vector<double> flow_l_per_min; ///< same length
  QuadraticFit fit;
  std::optional<double> frequency_Hz, stroke_mm,
      voltage_V; ///< the pump was driven with, where the file states them
};

/// One head of a measured curve: what the fit gives there, and what its nearest sample measured.
struct ExtractedPoint {
  double head_mmHg = 0;
  double fit_l_per_min = 0;
  double nearest_head_mmHg = 0;
  double nearest_l_per_min = 0;
};

/// Reads a CSV file with the header line `head_mmHg,flow_l_per_min`, one sample per line; lines that start
/// with # and empty lines are skipped, but for `# frequency_Hz = 120`, `# stroke_mm = 0.53` and
/// `# voltage_V = 40` (or with a colon) before the header. What spreadsheets write is read alike: a byte
/// order mark, UTF-16 with one, quotes around fields, signs in front of numbers, rows of commas alone. Throws
/// InputError with file and line for a missing file, another header, a frequency or stroke that is not a
/// positive number or stated twice, a line that is not two finite numbers, and for fewer than three different
/// heads.
MeasuredCurve read_measured_curve(const std::filesystem::path& file);

/// Least-squares parabola through samples (same lengths, at least three different heads).
QuadraticFit fit_quadratic(std::span<const double> head_mmHg, std::span<const double> flow_l_per_min);

/// Extracts the curve at the given heads. Throws InputError for a head outside the measured range: neither
/// the fit nor a sample says anything there.
std::vector<ExtractedPoint> extract_points(const MeasuredCurve& curve, std::span<const double> heads_mmHg);

} // namespace undula::rom
