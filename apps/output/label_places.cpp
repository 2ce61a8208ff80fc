#include "apps/output/label_places.hpp"

#include <algorithm>
#include <cmath>

namespace undula::apps {
namespace {

constexpr int rings = 12; ///< of places around a mark, one line further out each
constexpr double mark_size = 0.8;

/// A label or a mark, by its centre.
struct Box {
  double x, y, width, height;
};

bool overlap(const Box& a, const Box& b) {
  return std::abs(a.x - b.x) < (a.width + b.width) / 2 && std::abs(a.y - b.y) < (a.height + b.height) / 2;
}

} // namespace

std::vector<std::pair<double, double>> label_offsets(const std::vector<LabelledMark>& marks) {
  std::vector<Box> taken;
  for (const LabelledMark& mark : marks) {
    taken.push_back({mark.x, mark.y, mark_size, mark_size});
  }
  std::vector<std::pair<double, double>> offsets;
  for (const LabelledMark& mark : marks) {
    const double width = static_cast<double>(mark.text.size()) + 0.4;
    const auto is_free = [&](const std::pair<double, double>& place) {
      const Box label{mark.x + place.first, mark.y + place.second, width, 1};
      return std::none_of(taken.begin(), taken.end(), [&](const Box& box) { return overlap(label, box); });
    };
    std::vector<std::pair<double, double>> places;
    for (int ring = 0; ring < rings; ++ring) {
      for (const double up : {1.0, -1.0}) {
        for (const double right : {0.0, 1.0, -1.0}) {
          places.emplace_back(right * (mark_size + width) / 2, up * (ring + 1));
        }
      }
    }
    const auto found = std::find_if(places.begin(), places.end(), is_free);
    const auto offset = found == places.end() ? places.back() : *found;
    taken.push_back({mark.x + offset.first, mark.y + offset.second, width, 1});
    offsets.push_back(offset);
  }
  return offsets;
}

} // namespace undula::apps
