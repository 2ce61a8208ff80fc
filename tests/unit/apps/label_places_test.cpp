// Labels of marks that lie close together.
#include "apps/output/label_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace undula::apps {
namespace {

TEST(LabelPlaces, OfOneMarkAreBesideIt) {
  const auto offsets = label_offsets({{10, 10, "7"}});
  ASSERT_EQ(offsets.size(), 1u);
  EXPECT_EQ(offsets[0], (std::pair<double, double>(0, 1)));
}

TEST(LabelPlaces, OfTwelveMarksInAHeapDoNotCoverEachOther) {
  std::vector<LabelledMark> marks;
  for (int i = 0; i < 12; ++i) {
    marks.push_back({20 + 0.3 * i, 10 + 0.05 * (i % 3), std::to_string(i + 1)});
  }
  const auto offsets = label_offsets(marks);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double x = marks[i].x + offsets[i].first, y = marks[i].y + offsets[i].second;
    for (std::size_t j = 0; j < i; ++j) {
      const double width = static_cast<double>(marks[i].text.size() + marks[j].text.size()) / 2;
      const bool apart = std::abs(x - marks[j].x - offsets[j].first) >= width ||
                         std::abs(y - marks[j].y - offsets[j].second) >= 1;
      EXPECT_TRUE(apart) << marks[i].text << " covers " << marks[j].text;
    }
    for (const LabelledMark& mark : marks) {
      EXPECT_TRUE(std::abs(x - mark.x) >= 0.5 || std::abs(y - mark.y) >= 0.5) << marks[i].text;
    }
  }
}

} // namespace
} // namespace undula::apps
