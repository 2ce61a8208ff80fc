// Stated problems by their outlines: what passes and what does not. The messages are in
// tests/data/bad/scenes.
#include "fom/scene/statement_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fom/levels/scene_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

constexpr const char* tank = R"toml(
name = "tank"
[model]
space = "plane"
[domain]
outline_mm = [[0.0, 0.0], [40.0, 0.0], [40.0, 10.0], [0.0, 10.0]]
sides = ["lower", "right", "upper", "left"]
size_mm = 2.0
[fluid]
density_g_per_cm3 = 1.0
viscosity_poise = 0.01
[time]
step_s = 0.01
end_s = 0.1
)toml";

Scene with(const std::string& more, const std::vector<std::string>& settings = {}) {
  return parse_scene(tank + more, "tank", "/", settings);
}

std::string block(const std::string& name, double left, double low, double right, double high,
                  const std::string& more = "held = \"1\"\n") {
  const auto corner = [](double x, double y) {
    return "[" + std::to_string(x) + ", " + std::to_string(y) + "]";
  };
  return "[body." + name + "]\noutline_mm = [" + corner(left, low) + ", " + corner(right, low) + ", " +
         corner(right, high) + ", " + corner(left, high) + "]\nsize_mm = 1.0\n" + more;
}

const std::string soft = "density_g_per_cm3 = 1.0\nyoung_dyn_per_cm2 = 1e5\n";

std::string inflow(const std::string& side, const std::string& u) {
  return "[boundary." + side + "]\nkind = \"velocity\"\nvelocity_cm_per_s = [\"" + u + "\", \"0\"]\n";
}

std::string message_of(const std::string& more) {
  try {
    with(more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StatementGeometry, ClosedFlowsMayGoRound) {
  EXPECT_EQ(message_of(""), "");
  EXPECT_EQ(message_of("[boundary.upper]\nkind = \"velocity\"\nvelocity_cm_per_s = [\"1\", \"0\"]\n"),
            ""); // a lid
  EXPECT_EQ(message_of(inflow("left", "y*(10 - y)") + inflow("right", "y*(10 - y)")), "");
  EXPECT_NE(message_of(inflow("left", "y*(10 - y)") + inflow("right", "0.9*y*(10 - y)"))
                .find("nothing lets it out"),
            std::string::npos);
  // Nothing flows in at first.
  EXPECT_NE(message_of(inflow("left", "ramp(t, 0.1)")).find("nothing lets it out"), std::string::npos);
}

TEST(StatementGeometry, WallsThatYieldTakeInWhatFlowsIn) {
  EXPECT_EQ(message_of(inflow("left", "1") + block("leaf", 20, -1, 21, 11, soft)), "");
  EXPECT_NE(message_of(inflow("left", "1") + block("leaf", 20, -1, 21, 11)).find("flows in"),
            std::string::npos);
  EXPECT_EQ(message_of(inflow("left", "1") +
                       block("piston", 20, -1, 21, 11, "held = \"1\"\ndisplacement_mm = [\"t\", \"0\"]\n")),
            "");
}

TEST(StatementGeometry, APartOfTheFluidNeedsAPressureLevel) {
  const std::string open = "[boundary.left]\nkind = \"opening\"\n";
  EXPECT_EQ(message_of(open + block("post", 20, -1, 21, 9)), ""); // a gap is left above it
  EXPECT_NE(message_of(open + block("wall", 20, -1, 21, 11)).find("pressure in a part of the fluid"),
            std::string::npos);
  EXPECT_EQ(message_of(open + block("leaf", 20, -1, 21, 11, soft)), "");
  EXPECT_EQ(message_of(open + "[boundary.right]\nkind = \"opening\"\n" + block("wall", 20, -1, 21, 11)), "");
}

TEST(StatementGeometry, BodiesMayReachOutAndOverlapOutside) {
  const std::string bracket =
      "[body.bracket]\noutline_mm = [[11, -8], [30, -8], [30, 4], [28, 4], [28, -1], [11, -1]]\nsize_mm = "
      "1.0\n";
  EXPECT_EQ(message_of(block("leaf", 10, -8, 12, 5, soft) + bracket + soft), "");
  EXPECT_NE(message_of(block("one", 10, -8, 12, 5) + block("two", 11, -8, 30, 1)).find("over one another"),
            std::string::npos);
  // Along one side of the domain, and in a hole but for a corner.
  EXPECT_EQ(message_of(block("side", 0, 0, 4, 10)), "");
  EXPECT_EQ(
      message_of("[hole.pin]\ncentre_mm = [20, 5]\nradius_mm = 2\n" + block("flag", 20, 4.8, 26, 5.2, soft)),
      "");
}

TEST(StatementGeometry, PointsOnEdgesAreInTheFluid) {
  EXPECT_EQ(message_of("[hole.pin]\ncentre_mm = [20, 5]\nradius_mm = 2\n[point.front]\nat_mm = [18, 5]\n"
                       "[point.corner]\nat_mm = [0, 0]\n"),
            "");
  EXPECT_NE(message_of("[hole.pin]\ncentre_mm = [20, 5]\nradius_mm = 2\n[point.front]\nat_mm = [19, 5]\n")
                .find("[hole.pin]"),
            std::string::npos);
}

TEST(StatementGeometry, MessagesNameTheLine) {
  const std::string message = message_of("[point.far]\nat_mm = [50, 5]\n");
  EXPECT_NE(message.find("tank:16, key \"point.far.at_mm\""), std::string::npos) << message;
  try {
    with("[point.far]\nat_mm = [5, 5]\n", {"point.far.at_mm=[50.0, 5.0]"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--set point.far.at_mm"), std::string::npos) << error.what();
  }
}

TEST(StatementGeometry, EstimatesTheCellsOfItsMeshes) {
  const Scene scene =
      with(block("post", 20, -1, 21, 9, soft) + "[refine.spot]\nbox_mm = [[5, 2], [8, 6]]\nsize_mm = 0.2\n");
  const auto work = check_statement_geometry(scene, "tank");
  const auto problem = scene_problem(scene);
  EXPECT_NEAR(work.fluid_cells / mesh_quality(problem.background).cells, 1, 0.4);
  EXPECT_NEAR(work.solid_cells / mesh_quality(problem.solids[0].mesh).cells, 1, 0.5);
}

// A line from the circle through the body: the corners of the polygon that stands for the circle give way.
TEST(StatementGeometry, ALineThatEndsOnACircleLeavesNoFlatCell) {
  const auto smallest_angle = [](const std::string& line) {
    const Scene scene = with(
        "[body.ball]\ncentre_mm = [20, 5]\nradius_mm = 3\nsize_mm = 0.7\nheld = \"1\"\nline_mm = " + line +
        "\n");
    return mesh_quality(scene_problem(scene).solids[0].mesh).min_angle;
  };
  EXPECT_GT(smallest_angle("[[17.0, 5.0], [23.0, 5.0]]"), 15);
  const double x = 20 + 3 * std::cos(0.1), y = 5 + 3 * std::sin(0.1);
  EXPECT_GT(smallest_angle("[[20.0, 5.0], [" + std::to_string(x) + ", " + std::to_string(y) + "]]"), 15);
  const double p = 20 + 3 * std::cos(0.2), q = 5 + 3 * std::sin(0.2);
  EXPECT_GT(smallest_angle("[[20.0, 5.0], [" + std::to_string(p) + ", " + std::to_string(q) + "]]"), 15);
  EXPECT_NE(message_of("[body.ball]\ncentre_mm = [20, 5]\nradius_mm = 3\nsize_mm = 0.7\nheld = \"1\"\n"
                       "line_mm = [[20.0, 5.0], [23.5, 5.0]]\n")
                .find("a line leaves its body"),
            std::string::npos);
}

TEST(StatementGeometry, CaresForNothingThatLiesFarApart) {
  EXPECT_EQ(message_of("[constants]\nU = 1\n" + block("one", 1, 1, 2, 2) + block("two", 30, 5, 39, 9)), "");
}

} // namespace
} // namespace undula::fom
