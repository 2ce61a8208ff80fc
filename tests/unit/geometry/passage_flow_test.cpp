// Potential flow through channels of known inertance.
#include "geometry/mesh/passage_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "rom/base/error.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::geometry {
namespace {

using verification::spaced;
using verification::tensor_mesh;
constexpr double pi = std::numbers::pi;

bool everywhere(const Point<2>&) { return true; }

TEST(PassageFlow, OfAStraightAnnularChannelIsExact) {
  // 1 <= r <= 2, from the opening at z = 4 to the gaps at z = 1.
  const auto mesh = tensor_mesh(spaced(1, 2, 8), spaced(0, 4, 16));
  const auto flow = passage_flow(
      mesh, "top", [](const Point<2>& x) { return x.y() > 1; }, everywhere,
      [](const Point<2>&) { return 7.0; });
  const double area = 3 * pi;
  EXPECT_NEAR(flow.inertance, 3 / area, 1e-12);
  EXPECT_NEAR(flow.friction, 7 * 3 / area, 1e-11);
  EXPECT_NEAR(flow.narrowest, area, 1e-10);
}

TEST(PassageFlow, WeighsFrictionByTheSquaredVelocity) {
  const auto mesh = tensor_mesh(spaced(1, 2, 8), spaced(0, 4, 16));
  const auto flow = passage_flow(
      mesh, "top", [](const Point<2>& x) { return x.y() > 1; }, everywhere,
      [](const Point<2>& x) { return x.y() > 2 ? 5.0 : 0.0; }); // over two of the three cm
  EXPECT_NEAR(flow.friction, 5 * 2 / (3 * pi), 1e-11);
}

TEST(PassageFlow, OfARadialGapIsLogarithmic) {
  const double height = 0.5, exact = std::log(3.0) / (2 * pi * height);
  double error[2];
  for (const int level : {0, 1}) {
    const int n = level == 0 ? 40 : 80;
    const auto mesh = tensor_mesh(spaced(0.5, 3, 5 * n / 2), spaced(0, height, n / 4));
    const auto flow = passage_flow(
        mesh, "right", [](const Point<2>& x) { return x.x() > 1; }, everywhere,
        [](const Point<2>&) { return 0.0; });
    error[level] = std::abs(flow.inertance / exact - 1);
    EXPECT_EQ(flow.friction, 0);
    // Least at r = 1; the mean over the first of the bands of the potential.
    EXPECT_GT(flow.narrowest, 2 * pi * height);
    EXPECT_LT(flow.narrowest, 1.05 * 2 * pi * height);
  }
  EXPECT_LT(error[1], 1e-4);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2);
}

TEST(PassageFlow, FindsTheThroatOfAConstriction) {
  // A ring of wall at 1.5 <= z <= 2.5 leaves 1 <= r <= 1.25 open.
  const auto wall = [](const Point<2>& x) { return x.x() > 1.25 && x.y() > 1.5 && x.y() < 2.5; };
  const double throat = pi * (1.25 * 1.25 - 1), wide = 3 * pi;
  double before = 0;
  std::vector<double> error;
  for (const int n : {8, 16, 32}) {
    const auto mesh = tensor_mesh(spaced(1, 2, n), spaced(0, 4, 4 * n));
    const auto flow = passage_flow(
        mesh, "top", [&](const Point<2>& x) { return x.y() > 0.5 && !wall(x); },
        [&](const Point<2>& x) { return !wall(x); }, [](const Point<2>&) { return 0.0; });
    // Planes of one potential would resist less; finite elements come from below as well.
    EXPECT_GT(flow.inertance, 1 / throat + 2.5 / wide);
    EXPECT_GT(flow.inertance, before);
    EXPECT_LT(flow.inertance, 1.5 * (1 / throat + 2.5 / wide));
    before = flow.inertance;
    error.push_back(std::abs(flow.narrowest / throat - 1));
  }
  EXPECT_LT(error[2], 0.02);
  EXPECT_LT(error[2], error[0] / 2);
}

TEST(PassageFlow, SaysWhatIsMissing) {
  const auto mesh = tensor_mesh(spaced(1, 2, 4), spaced(0, 4, 8));
  const auto upper = [](const Point<2>& x) { return x.y() > 1; };
  const auto none = [](const Point<2>&) { return 0.0; };
  EXPECT_THROW(passage_flow(mesh, "chimney", upper, everywhere, none), InputError);
  EXPECT_THROW(passage_flow(mesh, "bottom", upper, everywhere, none), InputError); // not at the passage
  EXPECT_THROW(passage_flow(mesh, "top", upper, upper, none), InputError);         // no way on
  const auto closed = [](const Point<2>& x) { return std::abs(x.y() - 2) > 0.5; }; // walled off half-way
  EXPECT_THROW(passage_flow(
                   mesh, "top", [&](const Point<2>& x) { return closed(x) && x.y() > 1; }, closed, none),
               InputError);
}

} // namespace
} // namespace undula::geometry
