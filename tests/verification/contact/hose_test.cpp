// A thick hose between plates: the stress that a published pump prints.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fom/output/level_view.hpp"
#include "tests/verification/support/run_scene.hpp"

namespace undula::verification {
namespace {

TEST(SqueezedHose, HasTheStressOfItsPublishedPump) {
  const Scene scene = read_scene(UNDULA_SOURCE_DIR "/data/scenes/squeezed_hose.toml");
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  const auto view = level->view(scene);
  State state = level->initial_state();
  std::vector<double> last;
  march(*level, scene, state, timer,
        [&](const State&, const Observation& seen) { last = observation_row(seen, view.rows); });
  const auto columns = observation_columns(view.rows);
  const auto value = [&](const std::string& name) {
    return last.at(
        static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin()));
  };
  const auto stress = field_named(view.solid_fields(state), "von_mises").values;
  const auto& points = view.solids.points;  // at rest
  const auto at = [&](double x, double y) { // MPa, at the node nearest to a place at rest, cm
    std::size_t best = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((points[i] - Point<2>(x, y)).norm() < (points[best] - Point<2>(x, y)).norm()) best = i;
    return stress[best] / 1e7;
  };
  const double most = *std::max_element(stress.begin(), stress.end()) / 1e7, under_plate = at(0, 1.6),
               side = at(3.1, 0);
  const double bore = 32 + value("top_displacement_y_mm") - value("bottom_displacement_y_mm");
  std::printf(
      "%d unknowns: bore %.3f mm, von Mises %.2f (bore under a plate), %.2f (outer side), %.2f MPa "
      "(creases), "
      "plate %.0f N/m, bore %.0f N/m\n",
      level->unknowns(), bore, under_plate, side, most, value("upper_load_N_per_m"),
      value("bore_load_N_per_m"));
  EXPECT_NEAR(bore, 4, 1.5); // 4 mm if the wall kept its thickness
  EXPECT_NEAR(value("upper_load_N_per_m"), value("lower_load_N_per_m"), 0.01 * value("upper_load_N_per_m"));
  // Folded flat: E times wall / (bore + wall) is 12.1 MPa; printed are 14.
  for (const double skin : {under_plate, side}) {
    EXPECT_GT(skin, 0.7 * 12.1);
    EXPECT_LT(skin, 1.4 * 14);
  }
}

} // namespace
} // namespace undula::verification
