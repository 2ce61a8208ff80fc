#include "geometry/mesh/polygons.hpp"

#include <gtest/gtest.h>

namespace {

using namespace undula::geometry;

TEST(Polygons, ThePointNearestOnASegmentIsItsFootOrAnEnd) {
  const Point<2> a(1, 1), b(5, 1);
  EXPECT_EQ(nearest_on_segment<2>(a, b, {2, 7}), 0.25);
  EXPECT_EQ(nearest_on_segment<2>(a, b, {0, 3}), 0);
  EXPECT_EQ(nearest_on_segment<2>(a, b, {9, 1}), 1);
  EXPECT_EQ(distance_to_segment<2>(a, b, {2, 7}), 6);
  EXPECT_EQ(distance_to_segment<2>(a, b, {-2, 5}), 5);
  EXPECT_EQ(distance_to_segment<2>(a, b, {4, 1}), 0);
  EXPECT_EQ(distance_to_segment<3>({0, 0, 0}, {0, 0, 2}, {3, 4, 1}), 5);
}

TEST(Polygons, AnOutlineWithAHoleHoldsWhatLiesBetween) {
  auto sides = polygon_sides({{0, 0}, {6, 0}, {6, 6}, {0, 6}});
  ASSERT_EQ(sides.size(), 4u);
  EXPECT_EQ(sides.back().b, Point<2>(0, 0));
  for (const auto& side : polygon_sides({{2, 2}, {2, 4}, {4, 4}, {4, 2}})) sides.push_back(side);
  EXPECT_TRUE(inside_outline(sides, {1, 1}));
  EXPECT_TRUE(inside_outline(sides, {1, 3}));
  EXPECT_FALSE(inside_outline(sides, {3, 3}));
  EXPECT_FALSE(inside_outline(sides, {7, 3}));
  EXPECT_FALSE(inside_outline(sides, {-1, 3}));
}

TEST(Polygons, RaysThroughCornersCountOnce) {
  const auto diamond = polygon_sides({{0, -1}, {1, 0}, {0, 1}, {-1, 0}});
  EXPECT_TRUE(inside_outline(diamond, {0, 0}));
  EXPECT_FALSE(inside_outline(diamond, {-2, 0}));
  EXPECT_FALSE(inside_outline(diamond, {-2, 1}));
}

TEST(Polygons, TheAreaHasTheSignOfTheDirection) {
  EXPECT_EQ(polygon_area({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}), 4);
  EXPECT_EQ(polygon_area({{0, 3}, {1, 3}, {1, 1}, {2, 1}, {2, 0}, {0, 0}}), -4);
}

} // namespace
