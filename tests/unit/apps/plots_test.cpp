// Pictures: drawn whole, restylable, and no obstacle where gnuplot is missing.
#include "apps/output/plots.hpp"

#include <gtest/gtest.h>

#include "apps/apps.hpp"
#include "apps/output/gnuplot.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

/// Pixels of a PNG, from the fixed place of width and height in its header; 0 x 0 for anything else.
std::array<int, 2> png_size(const std::filesystem::path& file) {
  const std::string bytes = text_of(file);
  if (bytes.size() < 24 || !bytes.starts_with("\x89PNG\r\n\x1a\n")) {
    return {0, 0};
  }
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = 256 * value + static_cast<unsigned char>(bytes[i]);
    }
    return value;
  };
  return {number(16), number(20)};
}

const std::vector<double> head = {40, 50, 60};
const std::vector<double> flow = {3.2, 1.9, 0.35};
const std::vector<double> error = {0.1, 0.2, 0.1};

TEST(Plots, AnHqCurveIsDrawnAndItsScriptDrawsItAgain) {
  const ScratchFolder folder;
  const auto picture = folder.path() / "it's.png"; // a name that needs care in scripts
  const std::array<HqPoints, 2> sets = {{{"measured", head, error}, {"none", {}, {}}}};
  const std::array<HqLine, 2> lines = {{{"line", head, flow, error, "band"}, {"other", head, error, {}, ""}}};
  ASSERT_TRUE(plot_hq_curves(picture, "a title", lines, sets));
  EXPECT_EQ(png_size(picture), (std::array<int, 2>{1000, 700}));
  EXPECT_NE(text_of(folder.path() / "it's.dat").find("\n3.2 40\n"), std::string::npos);
  EXPECT_NE(text_of(folder.path() / "it's.dat").find("\n3.3 40\n"), std::string::npos); // edge of the band

  const std::string first = text_of(picture);
  std::filesystem::remove(picture);
  const std::string again = "cd '" + folder.path().string() + "' && gnuplot \"it's.gp\"";
  ASSERT_EQ(std::system(again.c_str()), 0);
  EXPECT_EQ(text_of(picture), first);
}

TEST(Plots, LinesAndFieldsAreDrawn) {
  const ScratchFolder folder;
  const std::array<Line, 2> lines = {{{"one", head, flow}, {"two", head, error}}};
  EXPECT_TRUE(plot_lines(folder.path() / "lines.png", "title", "time (s)", "flow (l/min)", lines));
  EXPECT_EQ(png_size(folder.path() / "lines.png")[0], 1000);

  const std::vector<Eigen::Vector2d> points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<double> values = {0, 3, 6, 9};
  const std::vector<std::vector<Eigen::Vector2d>> outlines = {
      {{0.2, 0.2}, {0.8, 0.2}, {0.5, 0.8}, {0.2, 0.2}}};
  EXPECT_TRUE(plot_field(folder.path() / "field.png", "title", {points, triangles, values, "speed (cm/s)"},
                         outlines));
  EXPECT_EQ(png_size(folder.path() / "field.png")[0], 1000);
  // The colour of a triangle is its mean value: (0 + 3 + 6) / 3.
  EXPECT_NE(text_of(folder.path() / "field.dat").find("0 0 3\n1 0 3\n"), std::string::npos);
}

TEST(Plots, WithoutGnuplotTheScriptIsKeptAndAnOlderPictureStays) {
  const ScratchFolder folder;
  const auto picture = folder.path() / "curve.png";
  std::ofstream(picture) << "older";
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const std::array<Line, 1> lines = {{{"one", head, flow}}};
  const bool drawn = plot_lines(picture, "title", "x", "y", lines);
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(drawn);
  EXPECT_EQ(text_of(picture), "older");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "curve.gp"));
}

TEST(Plots, ABrokenScriptLeavesNoPicture) {
  const ScratchFolder folder;
  EXPECT_FALSE(draw_picture(folder.path() / "curve.png", "1 2\n", "plot nonsense(\n"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "curve.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "curve.png.tmp"));
  EXPECT_THROW(draw_picture(folder.path() / "curve.svg", "", ""), InputError);
}

} // namespace
} // namespace undula::apps
