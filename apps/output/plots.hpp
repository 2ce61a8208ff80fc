// The pictures of Undula: head-flow curves, lines over an axis, fields on triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace undula::apps {

/// A curve, with a band of +- error where `error_l_per_min` is not empty; arrays of the same length, in the
/// order of the curve.
struct HqLine {
  std::string label;
  std::span<const double> head_mmHg;
  std::span<const double> flow_l_per_min;
  std::span<const double> error_l_per_min; ///< half width of the band; empty: no band
  std::string band_label;
};

/// What stands beside the line: points (measured, full-order runs), or another curve.
struct HqPoints {
  std::string label;
  std::span<const double> head_mmHg;
  std::span<const double> flow_l_per_min;
  bool as_curve = false; ///< a dashed line through them, in their order
  int line = -1;         ///< that they belong to and share the colour of, where there are several
};

/// Head over flow: lines with their bands, and any number of sets of points (empty sets are left out).
/// Returns false, after a warning, where gnuplot is missing.
bool plot_hq_curves(const std::filesystem::path& picture, const std::string& title,
                    std::span<const HqLine> lines, std::span<const HqPoints> point_sets);

struct Line {
  std::string label;
  std::span<const double> x;
  std::span<const double> y; ///< same length as x
};

/// Lines over one axis: time series, the membrane at several phases.
bool plot_lines(const std::filesystem::path& picture, const std::string& title, const std::string& x_label,
                const std::string& y_label, std::span<const Line> lines);

/// A field on triangles, filled, with outlines (polylines, cm) drawn over it.
/// `values` holds one value per point; there is at least one triangle.
struct FieldOnTriangles {
  std::span<const Eigen::Vector2d> points; ///< cm
  std::span<const std::array<int, 3>> triangles;
  std::span<const double> values;
  std::string label; ///< quantity and unit, beside the colours
  std::array<const char*, 2> axes = {"r (cm)", "z (cm)"};
};
bool plot_field(const std::filesystem::path& picture, const std::string& title, const FieldOnTriangles& field,
                std::span<const std::vector<Eigen::Vector2d>> outlines);

/// Straight pieces (cm) with a colour each, over thin outlines. `values` holds one value per piece.
struct ColouredPieces {
  std::span<const std::array<Eigen::Vector2d, 2>> pieces;
  std::span<const double> values;
  std::string label; ///< quantity and unit, beside the colours
};
bool plot_pieces(const std::filesystem::path& picture, const std::string& title,
                 const ColouredPieces& coloured, std::span<const std::vector<Eigen::Vector2d>> outlines);

} // namespace undula::apps
