// Where labels of marks go in a picture, so that they do not cover each other.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace undula::apps {

/// A mark, in columns and lines of text, and its label.
struct LabelledMark {
  double x = 0, y = 0;
  std::string text;
};

/// Offsets of the labels' centres from their marks, in columns and lines: each the nearest of a few places
/// around its mark that neither covers a label before it nor any mark. Where none is free, the furthest.
std::vector<std::pair<double, double>> label_offsets(const std::vector<LabelledMark>& marks);

} // namespace undula::apps
