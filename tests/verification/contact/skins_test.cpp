// Contact between deformable skins: a patch test, Hertz's cylinders, a hose whose bore closes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "tests/verification/support/run_scene.hpp"

namespace undula::verification {
namespace {

constexpr double mm = 0.1, N_per_m = 1000; // cgs

/// A scene of tests/data/contact.
SceneRun run_test_scene(const std::string& name, std::vector<std::string> settings = {}) {
  return run_scene("../../tests/data/contact/" + name, std::move(settings));
}

TEST(SkinContact, AUniformPressurePassesExactlyBetweenMeshesThatDoNotMatch) {
  const auto run = run_test_scene("two_blocks");
  const auto at = [&](const std::string& point, const char* axis) {
    return run.last(point + "_displacement_" + axis + "_mm") * mm;
  };
  const double pressure = 1e4, E = 1e7, nu = 0.3;
  const double down = -pressure * (1 - nu * nu) / E, wide = pressure * nu * (1 + nu) / E; // strains
  const double film = pressure / (10 * E / (1.3 * mm));                                   // of the pair
  const auto expect = [](const char* what, double found, double exact) {
    std::printf("%s: off by %.1e\n", what, std::abs(found / exact - 1));
    EXPECT_NEAR(found, exact, 1e-10 * std::abs(exact));
  };
  expect("lower block", at("lower_top", "y") - at("lower_middle", "y"), down * 2.5 * mm);
  expect("upper block", at("upper_top", "y") - at("upper_bottom", "y"), down * 5 * mm);
  expect("across", at("upper_right", "x") - at("upper_left", "x"), wide * 8 * mm);
  EXPECT_NEAR(at("lower_top", "y") - at("upper_bottom", "y"), film, 1e-10 * -down * mm);
  expect("load", run.last("middle_load_N_per_m") * N_per_m, pressure * 10 * mm);
}

TEST(SkinContact, TwoCylindersMeetAsHertzSays) {
  const auto run = run_test_scene("two_cylinders");
  const double half_modulus = 0.5e7 / (1 - 0.3 * 0.3), R = 5 * mm;
  const double load = run.last("touch_load_N_per_m") * N_per_m;
  const double a = std::sqrt(4 * load * R / (std::numbers::pi * half_modulus)),
               p = std::sqrt(load * half_modulus / (std::numbers::pi * R));
  const double width = 0.5 * run.last("touch_length_mm") * mm,
               pressure = run.last("touch_pressure_max_dyn_per_cm2");
  std::printf(
      "%d unknowns, load %.1f N/m: half width %.4f mm (%+.2f %%), pressure %.4g dyn/cm^2 (%+.2f %%)\n",
      run.unknowns, load / N_per_m, width / mm, 100 * (width / a - 1), pressure, 100 * (pressure / p - 1));
  EXPECT_GT(a, 0.4 * mm);
  EXPECT_NEAR(width, a, 0.02 * a);
  EXPECT_NEAR(pressure, p, 0.02 * p);
}

TEST(SkinLoad, ATubeUnderPressureWidensAsLameSays) {
  const auto run = run_test_scene("pressed_tube");
  const double pressure = 10 * 1333.22, E = 1e7, nu = 0.3, a = 1, b = 2; // cgs
  const double exact = 2 * (1 - nu * nu) * pressure * a * a * b / (E * (b * b - a * a));
  const double found = 0.5 * (run.last("right_displacement_x_mm") - run.last("left_displacement_x_mm")) * mm;
  std::printf("%d unknowns: outer skin %.6f mm (%+.3f %%)\n", run.unknowns, found / mm,
              100 * (found / exact - 1));
  EXPECT_NEAR(found, exact, 0.01 * exact); // the pressure follows the skin, which widens by 0.4 %
}

/// A fluid on one side of the skin, a roller on the other.
TEST(SkinContact, ARollerOnTheDrySideOfAWallPressesTheFluidOut) {
  const auto run = run_test_scene("pressed_channel");
  const auto left = run.column("left_outflow_cm2_per_s"), right = run.column("right_outflow_cm2_per_s"),
             under = run.column("under_displacement_y_mm"), load = run.column("press_load_N_per_m");
  double out = 0;
  for (std::size_t k = 0; k < left.size(); ++k) out += (left[k] + right[k]) * run.scene.time.step; // cm^2
  std::printf("the wall goes down by %.3f mm, %.4f cm^2 flow out, load %.3f N/m\n", -under.back(), out,
              load.back());
  EXPECT_NEAR(under.back(), -1.95, 0.1); // 2 mm less the clearance of 0.05 mm, and a part of the wall
  EXPECT_GT(load.back(), 1);
  // The wall is a clamped beam of 40 mm pressed in its middle: it sweeps half of what its middle does.
  EXPECT_NEAR(out, 0.5 * 0.1 * -under.back() * 4, 0.1 * out);
  EXPECT_NEAR(left.back() + right.back(), 0, 0.02 * *std::max_element(left.begin(), left.end()));
}

TEST(SkinContact, AHoseThatIsClosedDoesNotPassThroughItself) {
  const auto run = run_test_scene("closed_hose");
  const auto top = run.column("top_displacement_y_mm"), bottom = run.column("bottom_displacement_y_mm"),
             bore = run.column("bore_load_N_per_m"), upper = run.column("upper_load_N_per_m");
  double least = 1e300;
  for (std::size_t k = 0; k < top.size(); ++k) least = std::min(least, 17 + top[k] - bottom[k]);
  std::printf("%d unknowns: bore at least %.4f mm, bore %.1f, plate %.1f N/m, penetration %.4f mm\n",
              run.unknowns, least, bore.back(), upper.back(), run.last("bore_penetration_mm"));
  EXPECT_GT(bore.back(), 1);
  EXPECT_GT(least, -0.02); // mm; without the pair the walls pass by 0.14 mm
  EXPECT_EQ(bore[10], 0);
}

/// Pairs couple unknowns of several ranks: the pattern of the matrix grows on all of them.
TEST(SkinContactMpi, RanksTogetherFindWhatOneFinds) {
  for (const auto& [name, end] :
       {std::pair("two_blocks", "time.end_s=0.1"), {"pressed_channel", "time.end_s=0.04"}}) {
    const auto alone = run_test_scene(name, {end});
    PhaseTimer timer;
    const auto level = prepare_level(alone.scene, MPI_COMM_WORLD, timer);
    const RowLayout rows = level->view(alone.scene).rows;
    State state = level->initial_state();
    std::vector<double> last;
    march(*level, alone.scene, state, timer,
          [&](const State&, const Observation& seen) { last = observation_row(seen, rows); });
    for (std::size_t c = 0; c < last.size(); ++c) {
      const std::string& column = alone.table.columns[c];
      if (!column.ends_with("_mm") && !column.ends_with("_N_per_m")) continue;
      const double expected = alone.table.value(alone.table.rows() - 1, c);
      EXPECT_NEAR(last[c], expected, 1e-6 * std::abs(expected) + 1e-9) << name << ", " << column;
    }
  }
}

} // namespace
} // namespace undula::verification
